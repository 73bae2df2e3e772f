// The text form of a trace: one line a step, in the order in which the steps take effect.
//
//     12.300us  kernel/main      atomic_store   segment.state          := 1
//     12.400us  kernel/main      sem_post       handoff
//   1012.000us  emulator/main    atomic_load    segment.state          = 1
//
// Of a memory access the value is shown as an unsigned number in the machine's byte order; ":=" is what was
// written.
#pragma once

#include <cstddef>
#include <string>

#include "sim_clock/world/step_listener.hpp"

namespace ltsim {

class World;

class TextTrace final : public StepListener {
 public:
  explicit TextTrace(World& world) : world_(world) {}

  void arrives(const Task& task, const Operation& operation) noexcept override;
  void performs(const Task& task, const Operation& operation) noexcept override;
  void blocks(const Task& task) noexcept override;
  void ends(const Task& task) noexcept override;
  void older(const Task& task, const OlderStore& taken) noexcept override;
  void asks(const Task* task, std::string_view what) noexcept override;
  void notes(std::string_view text) noexcept override;

  /// All lines so far, the value of the last write included.
  [[nodiscard]] std::string text();

 private:
  void line(std::string_view task, std::string_view what, std::string_view place);
  /// A write is announced before it happens: its value is known at the next step.
  void finish_write();

  World& world_;
  std::string text_;
  Operation unfinished_write_;
  bool write_is_unfinished_ = false;
};

}  // namespace ltsim
