// A PLC that answers with the request's bytes, the top bit of each set: each answer tells its request.
#pragma once

#include <cstddef>
#include <span>

#include "emulator_models/i_plc_emulator.hpp"

namespace scenarios {

class MirrorPlc final : public emulator_models::IPlcEmulator {
 public:
  protocol::fx::FrameBytes process(std::span<const std::byte> request) noexcept override {
    protocol::fx::FrameBytes answer;
    for (const std::byte byte : request) answer.push_back(byte | std::byte{0x80});
    return answer;
  }
};

}  // namespace scenarios
