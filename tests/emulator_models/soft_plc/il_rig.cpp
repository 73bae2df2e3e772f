#include "tests/emulator_models/soft_plc/il_rig.hpp"

#include <cstdlib>
#include <iostream>
#include <sstream>

#include "emulator_models/soft_plc/il_lexer.hpp"

namespace emulator_models::soft_plc {
namespace {

constexpr std::int64_t ns_per_ms = 1'000'000;

bool is_image_byte(const std::string& name) {
  return name.size() > 1 && std::string_view{"IQM"}.find(name[0]) != std::string_view::npos &&
         name[1] >= '0' && name[1] <= '9';
}

std::uint64_t parsed(ElementaryType type, const std::string& text) {
  if (type == ElementaryType::real) return bits_of(std::strtof(text.c_str(), nullptr));
  if (type == ElementaryType::lreal) return bits_of(std::strtod(text.c_str(), nullptr));
  if (text.starts_with('-') || type == ElementaryType::time) {
    const std::int64_t number = std::strtoll(text.c_str(), nullptr, 10);
    return static_cast<std::uint64_t>(type == ElementaryType::time ? number * ns_per_ms : number);
  }
  return std::strtoull(text.c_str(), nullptr, 10);
}

std::string shown(ElementaryType type, std::uint64_t bits) {
  std::ostringstream text;
  if (type == ElementaryType::real) {
    text << as_real(bits);
  } else if (type == ElementaryType::lreal) {
    text << as_lreal(bits);
  } else if (type == ElementaryType::time) {
    text << static_cast<std::int64_t>(bits) / ns_per_ms;
  } else if (is_signed_integer(type)) {
    text << static_cast<std::int64_t>(bits);
  } else {
    text << bits;
  }
  return text.str();
}

}  // namespace

std::string program_of(std::string_view variables, std::string_view body) {
  std::string source{"PROGRAM p VAR "};
  source.append(variables).append(" END_VAR\n").append(body).append("\nEND_PROGRAM\n");
  return source;
}

Refusal refusal_of(std::string_view variables, std::string_view body) {
  const auto program = compile(program_of(variables, body));
  if (program) return {"compiled", "compiled"};
  const SourcePlace place = program.error().place;
  return {std::to_string(place.line) + ':' + std::to_string(place.column), program.error().message};
}

IlRig::IlRig(std::string_view variables, std::string_view body) {
  auto program = compile(program_of(variables, body));
  if (!program) {
    std::cerr << to_string(program.error()) << '\n';
    return;
  }
  program_ = std::move(*program);
  machine_ = std::make_unique<IlMachine>(program_);
}

std::string IlRig::scan(std::uint64_t budget) {
  const auto result = machine_->run_scan({inputs_, outputs_, memory_}, now_, budget);
  now_ += std::chrono::milliseconds{10};
  return result ? "ok" : to_string(result.error());
}

void IlRig::set(const std::string& name, const std::string& value) {
  if (is_image_byte(name)) {
    auto& image = name[0] == 'I' ? inputs_ : name[0] == 'Q' ? outputs_ : memory_;
    image.at(std::stoul(name.substr(1))) = static_cast<std::byte>(std::stoul(value));
    return;
  }
  const IlVariable* const variable = program_.find(upper(name));
  if (variable != nullptr) machine_->set_value(variable->name, parsed(variable->type, value));
}

std::string IlRig::get(const std::string& name) const {
  if (is_image_byte(name)) {
    const auto& image = name[0] == 'I' ? inputs_ : name[0] == 'Q' ? outputs_ : memory_;
    return std::to_string(std::to_integer<unsigned>(image.at(std::stoul(name.substr(1)))));
  }
  const IlVariable* const variable = program_.find(upper(name));
  if (variable == nullptr) return "no such variable";
  return shown(variable->type, machine_->value(variable->name).value_or(0));
}

std::string IlRig::run(std::string_view steps) {
  if (!valid()) return "does not compile";
  std::istringstream words{std::string{steps}};
  bool scanned = false;
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (word == ";") {
      scanned = false;
    } else if (word == "->") {
      scanned = true;
      if (const std::string result = scan(); result != "ok") return result;
    } else if (!scanned) {
      set(word.substr(0, equals), word.substr(equals + 1));
    } else if (const std::string found = get(word.substr(0, equals)); found != word.substr(equals + 1)) {
      return word + " expected at " + std::to_string(now_.count() - 10) + " ms, found " + found;
    }
  }
  return {};
}

}  // namespace emulator_models::soft_plc
