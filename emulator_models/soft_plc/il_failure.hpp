// How the parts of the compiler give up: an exception that parse() and compile() turn into a value. It never
// leaves this folder.
#pragma once

#include <string>
#include <utility>

#include "emulator_models/soft_plc/il_error.hpp"

namespace emulator_models::soft_plc {

struct IlFailure {
  IlError error;
};

[[noreturn]] inline void fail(SourcePlace place, std::string message) {
  throw IlFailure{{place, std::move(message)}};
}

}  // namespace emulator_models::soft_plc
