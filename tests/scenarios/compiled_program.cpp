#include "tests/scenarios/compiled_program.hpp"

#include <stdexcept>
#include <utility>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"

namespace scenarios {

emulator_models::soft_plc::IlProgram compiled_for_fx3u(std::string_view source) {
  auto program =
      emulator_models::soft_plc::compile(source, emulator_models::FxAddressMap{protocol::fx::Model::fx3u});
  if (!program) throw std::runtime_error{to_string(program.error())};
  return std::move(*program);
}

}  // namespace scenarios
