#include "emulator_models/soft_plc/il_functions.hpp"

namespace emulator_models::soft_plc {
namespace {

std::optional<IlFunction> find_conversion(std::string_view name) {
  constexpr std::string_view link = "_TO_";
  const std::size_t at = name.find(link);
  if (at == std::string_view::npos) return std::nullopt;
  const auto from = elementary_type(name.substr(0, at));
  const auto to = elementary_type(name.substr(at + link.size()));
  if (!from || !to || *from == *to) return std::nullopt;
  return IlFunction{IlFunction::Kind::convert, *from, *to, {"IN"}, false};
}

IlFunction function(IlFunction::Kind kind, std::vector<std::string_view> parameters,
                    bool extensible = false) {
  IlFunction result;
  result.kind = kind;
  result.parameters = std::move(parameters);
  result.extensible = extensible;
  return result;
}

}  // namespace

std::optional<IlFunction> find_function(std::string_view upper_name) {
  using Kind = IlFunction::Kind;
  if (upper_name == "ABS") return function(Kind::absolute, {"IN"});
  if (upper_name == "MIN") return function(Kind::minimum, {"IN1", "IN2"}, true);
  if (upper_name == "MAX") return function(Kind::maximum, {"IN1", "IN2"}, true);
  if (upper_name == "LIMIT") return function(Kind::limit, {"MN", "IN", "MX"});
  if (upper_name == "SEL") return function(Kind::select, {"G", "IN0", "IN1"});
  if (upper_name == "SHL") return function(Kind::shift_left, {"IN", "N"});
  if (upper_name == "SHR") return function(Kind::shift_right, {"IN", "N"});
  if (upper_name == "ROL") return function(Kind::rotate_left, {"IN", "N"});
  if (upper_name == "ROR") return function(Kind::rotate_right, {"IN", "N"});
  return find_conversion(upper_name);
}

}  // namespace emulator_models::soft_plc
