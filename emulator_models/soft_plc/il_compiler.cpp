#include "emulator_models/soft_plc/il_compiler.hpp"

#include "emulator_models/soft_plc/il_address.hpp"
#include "emulator_models/soft_plc/il_failure.hpp"
#include "emulator_models/soft_plc/il_instruction_compiler.hpp"
#include "emulator_models/soft_plc/il_parser.hpp"

namespace emulator_models::soft_plc {

namespace {

/// The soft PLC's own: % addresses alone.
class PlainAddressMap final : public AddressMap {
 public:
  [[nodiscard]] tl::expected<ValuePlace, std::string> address(std::string_view text) const override {
    const auto found = parse_address(text);
    if (!found) return tl::unexpected(found.error());
    const std::string_view read_only_as = found->area == Area::inputs ? "a physical input" : "";
    return ValuePlace{found->type, found->area, found->byte_index, found->bit_index, read_only_as};
  }
  [[nodiscard]] tl::expected<ValuePlace, std::string> device(std::string_view upper_name,
                                                             ElementaryType) const override {
    return tl::unexpected(std::string{upper_name} +
                          " is no address: AT is followed by an address such as %IX0.0 or %MW5");
  }
  [[nodiscard]] std::optional<tl::expected<ValuePlace, std::string>> undeclared(
      std::string_view) const override {
    return std::nullopt;
  }
  [[nodiscard]] std::optional<tl::expected<PlcBlock, std::string>> block(std::string_view) const override {
    return std::nullopt;
  }
};

}  // namespace

tl::expected<IlProgram, IlError> compile(std::string_view source) {
  return compile(source, PlainAddressMap{});
}

tl::expected<IlProgram, IlError> compile(std::string_view source, const AddressMap& map) {
  if (source.size() > source_bytes_max)
    return tl::unexpected(
        IlError{{}, "the source is longer than " + std::to_string(source_bytes_max) + " bytes: shorten it"});
  const auto tree = parse(source);
  if (!tree) return tl::unexpected(tree.error());
  try {
    IlProgram program;
    program.name = tree->program_name;
    const SymbolTable symbols = lay_out(*tree, map, program);
    InstructionCompiler{program, symbols, *tree, map}.run();
    return program;
  } catch (IlFailure& found) {
    return tl::unexpected(std::move(found.error));
  }
}

}  // namespace emulator_models::soft_plc
