// All waiting of a run: while it waits it obeys the operator's panel and, where asked, looks after the PLC's health.
//
// It keeps what the operator has decided: feed hold, program stop, the switch for M1.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "kernel_mocks/geometry_task.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "kernel_mocks/notifier.hpp"
#include "kernel_mocks/run_result.hpp"
#include "kernel_mocks/runner_options.hpp"

namespace kernel_mocks {

class RunWatch {
 public:
  /// Made at the program start: an operator's times count from here. All must outlive the watch.
  RunWatch(LogicTask& logic_task, GeometryTask& geometry, Notifier& notifier, const RunnerOptions& options);

  [[nodiscard]] bool is_held() const noexcept { return held_; }
  [[nodiscard]] bool optional_stop() const noexcept { return optional_stop_; }

  /// Before each block: tells the operator of it, obeys the panel, and waits while a feed hold is active.
  RunStep begin_block(const Block& block);
  /// At M0: waits for cycle start as long as somebody is there to press it.
  RunStep wait_at_stop(const Block& block);

  /// Waits until `ready()`.
  template <typename Ready>
  RunStep wait_until(const std::string& where, Ready ready) {
    while (!ready()) {
      if (auto done = look(where); !done) return done;
      notifier_.wait_for(logic_task_.options().poll_interval);
    }
    return {};
  }

  /// Waits until `is_over()`, or until `heed(status)` of a PLC that is well; an alarm, an open emergency-stop chain
  /// or a lost link ends the wait as a failure.
  /// @param is_over  asked first, so that nothing waits for an exchange when there is nothing to wait for
  template <typename IsOver, typename Heed>
  RunStep wait_watching(const std::string& where, IsOver is_over, Heed heed) {
    while (!is_over()) {
      const auto status = logic_task_.healthy_status();
      if (!status) return tl::unexpected{failed_at(where, status.error())};
      if (heed(*status)) break;
      if (auto done = look(where); !done) return done;
      notifier_.wait_for(logic_task_.options().poll_interval);
    }
    return {};
  }

 private:
  RunStep look(const std::string& where);
  RunStep obey(const std::string& where, OperatorEvent event);
  RunStep set_held(const std::string& where, bool held);
  RunStep wait_for_cycle_start(const Block& block, const bool& waiting, const char* why);
  [[nodiscard]] bool is_attended() const;

  LogicTask& logic_task_;
  GeometryTask& geometry_;
  Notifier& notifier_;
  const RunnerOptions& options_;
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  bool optional_stop_;
  bool held_ = false;
  bool stopped_ = false;
};

}  // namespace kernel_mocks
