// A soft PLC for tests: a program in instruction list, its images, and time that passes by hand.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"

namespace emulator_models::soft_plc {

/// Line 1 holds the declarations, so that the first instruction is line 2.
[[nodiscard]] std::string program_of(std::string_view variables, std::string_view body);

/// "3:1" and what the message says, or "compiled" when nothing is wrong.
struct Refusal {
  std::string place;
  std::string message;
};
[[nodiscard]] Refusal refusal_of(std::string_view variables, std::string_view body);

class IlRig {
 public:
  /// A test that uses a program which does not compile has failed; valid() is false then.
  IlRig(std::string_view variables, std::string_view body);

  [[nodiscard]] bool valid() const noexcept { return machine_ != nullptr; }
  [[nodiscard]] const IlProgram& program() const noexcept { return program_; }
  [[nodiscard]] IlMachine& machine() noexcept { return *machine_; }

  /// One scan, then 10 ms pass.
  /// @return "ok", or the fault
  std::string scan(std::uint64_t budget = IlMachine::default_budget);

  /// Bytes of the images are I0, Q3, M15; anything else is a variable. Numbers for integers, bit strings and
  /// BOOL, with a point for reals, milliseconds for TIME.
  void set(const std::string& name, const std::string& value);
  [[nodiscard]] std::string get(const std::string& name) const;

  /// Steps such as "a=1 b=0 -> q=1 ; a=0 -> q=0", a scan each. @return "", or the first that is not so
  std::string run(std::string_view steps);

 private:
  IlProgram program_;
  std::unique_ptr<IlMachine> machine_;
  std::array<std::byte, 16> inputs_{};
  std::array<std::byte, 16> outputs_{};
  std::array<std::byte, 16> memory_{};
  std::chrono::milliseconds now_{0};
};

}  // namespace emulator_models::soft_plc
