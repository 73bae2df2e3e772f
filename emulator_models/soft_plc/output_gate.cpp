#include "emulator_models/soft_plc/output_gate.hpp"

#include <utility>

namespace emulator_models::soft_plc {

std::uint64_t OutputGate::open(bool hold_outputs) noexcept {
  const std::lock_guard lock{mutex_};
  if (open_ && !hold_outputs) make_safe();
  open_ = true;
  return ++epoch_;
}

bool OutputGate::commit(std::uint64_t run, std::span<const std::byte> mask,
                        std::span<const std::byte> outputs) noexcept {
  const std::lock_guard lock{mutex_};
#ifdef LTSIM_MUTANT_COMMIT_OF_ANY_RUN
  run = epoch_;
#endif
  if (!open_ || run != epoch_) {
    ++dropped_commits_count_;
    return false;
  }
#ifdef LTSIM_MUTANT_COMMIT_TESTED_BEFORE  // what was tested is not what is written
  mutex_.unlock();
  mutex_.lock();
#endif
  for (std::size_t i = 0; i < mask.size(); ++i)
    outputs_[i] = (outputs_[i] & ~mask[i]) | (outputs[i] & mask[i]);
  return true;
}

bool OutputGate::close(std::uint64_t run) noexcept {
  const std::lock_guard lock{mutex_};
  if (!open_ || run != epoch_) return false;
  open_ = false;
  ++epoch_;
  make_safe();
  return true;
}

void OutputGate::make_safe() noexcept {
  outputs_ = safe_;
  if (on_safe_) on_safe_();
}

void OutputGate::on_safe(std::function<void()> listener) noexcept {
  const std::lock_guard lock{mutex_};
  on_safe_ = std::move(listener);
}

OutputGate::Frame OutputGate::frame() const noexcept {
  const std::lock_guard lock{mutex_};
  return {epoch_, outputs_};
}

bool OutputGate::is_open() const noexcept {
  const std::lock_guard lock{mutex_};
  return open_;
}

std::uint64_t OutputGate::dropped_commits_count() const noexcept {
  const std::lock_guard lock{mutex_};
  return dropped_commits_count_;
}

}  // namespace emulator_models::soft_plc
