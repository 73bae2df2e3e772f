#include "emulator_models/soft_plc/il_symbols.hpp"

#include <algorithm>

#include "emulator_models/soft_plc/il_failure.hpp"
#include "emulator_models/soft_plc/il_lexer.hpp"
#include "emulator_models/soft_plc/il_literal.hpp"

namespace emulator_models::soft_plc {
namespace {

std::string_view read_only_reason(const Declaration& declaration) noexcept {
  if (declaration.constant) return "a constant";
  if (declaration.section == VariableSection::input) return "an input of the program";
  return {};
}

void note_need(const ValuePlace& value, IlProgram& program) noexcept {
  std::size_t& needed = program.image_bytes_needed[static_cast<std::size_t>(value.area)];
  needed = std::max(needed, value.offset + size_bytes(value.type));
}

class Layout {
 public:
  Layout(const AddressMap& map, IlProgram& program) noexcept : map_{map}, program_{program} {}

  SymbolTable run(const SyntaxTree& tree) {
    const std::span<const Declaration> declarations = tree.declarations;
    for (const bool retained : {true, false}) {
      for (const Declaration& declaration : declarations) {
        if (declaration.retain == retained) add(declaration);
      }
      if (retained) program_.retained_bytes = program_.initial_variables.size();
    }
    for (const Statement& statement : tree.statements) {
      if (statement.operation.starts_with("JMP")) continue;  // its operand is a label
      for (const Operand& operand : statement.operands) add_undeclared(operand);
      for (const NamedArgument& argument : statement.arguments) add_undeclared(argument.operand);
    }
    return std::move(symbols_);
  }

 private:
  void add_undeclared(const Operand& operand) {
    if (operand.kind != Operand::Kind::name || symbols_.contains(operand.text)) return;
    if (const auto device = map_.undeclared(operand.text)) {
      if (!*device) fail(operand.place, device->error());
      note_need(**device, program_);
      symbols_.emplace(operand.text, **device);
      return;
    }
    const auto block = map_.block(operand.text);
    if (!block) return;
    if (!*block) fail(operand.place, block->error());
    const std::uint32_t offset = reserve(operand.place, instance_bytes((*block)->kind), block_alignment);
    construct((*block)->kind, program_.initial_variables.data() + offset, (*block)->devices);
    symbols_.emplace(operand.text, InstancePlace{(*block)->kind, offset, (*block)->devices});
  }

  void add(const Declaration& declaration) {
    if (map_.block(declaration.name))
      fail(declaration.place, declaration.name + " is a block of this PLC and there without a declaration");
    Symbol symbol;
    if (const auto type = elementary_type(declaration.type)) {
      symbol = add_variable(declaration, *type);
    } else if (const auto kind = block_kind(declaration.type)) {
      symbol = add_instance(declaration, *kind);
    } else {
      fail(declaration.type_place,
           declaration.type +
               " is no type of this PLC: elementary types but dates and strings, and the "
               "standard function blocks, can be declared");
    }
    if (!symbols_.emplace(declaration.name, symbol).second)
      fail(declaration.place, declaration.name + " is declared twice (capitals do not count): rename one");
  }

  std::uint32_t reserve(SourcePlace place, std::size_t bytes, std::size_t alignment) {
    std::vector<std::byte>& memory = program_.initial_variables;
    const std::size_t offset = (memory.size() + alignment - 1) / alignment * alignment;
    if (offset + bytes > variables_bytes_max)
      fail(place,
           "the variables take more than " + std::to_string(variables_bytes_max) + " bytes: use fewer");
    memory.resize(offset + bytes);
    return static_cast<std::uint32_t>(offset);
  }

  ValuePlace add_variable(const Declaration& declaration, ElementaryType type) {
    std::uint64_t initial = 0;
    if (!declaration.initial.empty())
      initial = literal_value(declaration.initial, type, declaration.initial_place);
    ValuePlace value;
    if (declaration.address.empty()) {
      value.type = type;
      value.offset = reserve(declaration.place, size_bytes(type), size_bytes(type));
      store(type, program_.initial_variables.data() + value.offset, initial);
    } else {
      value = add_at_address(declaration, type, initial);
    }
    if (value.read_only_as.empty()) value.read_only_as = read_only_reason(declaration);
    program_.variables.push_back(
        {declaration.name, declaration.section, type, value.area, value.offset, value.bit_index});
    return value;
  }

  ValuePlace add_at_address(const Declaration& declaration, ElementaryType type, std::uint64_t initial) {
    if (declaration.retain)
      fail(declaration.address_place,
           "what lies AT an address is kept or lost with the image: take RETAIN or AT away");
    ValuePlace value = declaration.address.starts_with('%')
                           ? place_of_address(declaration.address, declaration.address_place, map_, program_)
                           : place_of_device(declaration, type);
    const bool both_bits = type == ElementaryType::boolean && value.type == ElementaryType::boolean;
    const bool neither_bit = type != ElementaryType::boolean && value.type != ElementaryType::boolean;
    if (!both_bits && !(neither_bit && size_bytes(type) == size_bytes(value.type)))
      fail(declaration.address_place, std::string{declaration.address} + " has not the size of " +
                                          std::string{name_of(type)} +
                                          ": X is for BOOL, B, W, D and L for 1, 2, 4 and 8 bytes");
    value.type = type;
    if (!declaration.initial.empty()) {
      if (value.area == Area::inputs)
        fail(declaration.initial_place, "an input comes from outside and has no initial value");
      program_.image_initials.push_back({value.area, type, value.offset, value.bit_index, initial});
    }
    return value;
  }

  ValuePlace place_of_device(const Declaration& declaration, ElementaryType type) {
    const auto place = map_.device(upper(declaration.address), type);
    if (!place) fail(declaration.address_place, place.error());
    note_need(*place, program_);
    return *place;
  }

  InstancePlace add_instance(const Declaration& declaration, BlockKind kind) {
    const std::string name = std::string{name_of(kind)} + " ";
    if (!declaration.address.empty()) fail(declaration.address_place, name + "cannot lie AT an address");
    if (!declaration.initial.empty())
      fail(declaration.initial_place, name + "has no initial value: store its inputs with ST t.PT");
    if (declaration.constant) fail(declaration.place, name + "changes when called and cannot be CONSTANT");
    const std::uint32_t offset = reserve(declaration.place, instance_bytes(kind), block_alignment);
    construct(kind, program_.initial_variables.data() + offset, {});
    return {kind, offset, {}};
  }

  const AddressMap& map_;
  IlProgram& program_;
  SymbolTable symbols_;
};

}  // namespace

SymbolTable lay_out(const SyntaxTree& tree, const AddressMap& map, IlProgram& program) {
  return Layout{map, program}.run(tree);
}

ValuePlace place_in(const InstancePlace& instance, const BlockParameter& parameter) noexcept {
  const std::string_view read_only_as = parameter.is_input ? "" : "an output of a function block";
  switch (parameter.home) {
    case ParameterHome::contact:
      return {parameter.type, Area::memory, instance.devices.contact.byte_index,
              instance.devices.contact.bit_index, read_only_as};
    case ParameterHome::value:
      return {parameter.type, Area::memory, instance.devices.value_byte_index, 0, read_only_as};
    case ParameterHome::instance:
      break;
  }
  return {parameter.type, Area::variables, instance.offset + parameter.offset, 0, read_only_as};
}

ValuePlace place_of_address(std::string_view text, SourcePlace place, const AddressMap& map,
                            IlProgram& program) {
  const auto value = map.address(text);
  if (!value) fail(place, value.error());
  note_need(*value, program);
  return *value;
}

std::uint64_t literal_value(std::string_view text, ElementaryType type, SourcePlace place) {
  const auto literal = parse_literal(text);
  if (!literal) fail(place, std::string{text} + ": " + literal.error());
  const auto value = value_as(*literal, type);
  if (!value) fail(place, std::string{text} + ": " + value.error());
  return *value;
}

}  // namespace emulator_models::soft_plc
