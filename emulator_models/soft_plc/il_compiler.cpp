#include "emulator_models/soft_plc/il_compiler.hpp"

#include "emulator_models/soft_plc/il_failure.hpp"
#include "emulator_models/soft_plc/il_instruction_compiler.hpp"
#include "emulator_models/soft_plc/il_parser.hpp"

namespace emulator_models::soft_plc {

tl::expected<IlProgram, IlError> compile(std::string_view source) {
  if (source.size() > source_bytes_max)
    return tl::unexpected(
        IlError{{}, "the source is longer than " + std::to_string(source_bytes_max) + " bytes: shorten it"});
  const auto tree = parse(source);
  if (!tree) return tl::unexpected(tree.error());
  try {
    IlProgram program;
    program.name = tree->program_name;
    const SymbolTable symbols = lay_out(tree->declarations, program);
    InstructionCompiler{program, symbols, *tree}.run();
    return program;
  } catch (IlFailure& found) {
    return tl::unexpected(std::move(found.error));
  }
}

}  // namespace emulator_models::soft_plc
