// The thread of the logic task: carries out one handshake at a time while the runner does something else.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include <tl/expected.hpp>

#include "kernel_mocks/logic_task.hpp"
#include "kernel_mocks/notifier.hpp"

namespace kernel_mocks {

class FunctionWorker {
 public:
  using Clock = std::chrono::steady_clock;
  using Result = tl::expected<std::chrono::nanoseconds, LogicFailure>;

  /// @param notifier  told when the strobes have risen and when the handshake has ended
  FunctionWorker(LogicTask& logic_task, Notifier& notifier);
  FunctionWorker(const FunctionWorker&) = delete;
  FunctionWorker& operator=(const FunctionWorker&) = delete;
  /// As stop().
  ~FunctionWorker();

  /// Aborts the handshake under way, whose result comes at once; takes no request any more.
  void stop() noexcept;

  /// The result of the request before must have been taken.
  void give(const FunctionRequest& request) noexcept;
  /// When the PLC took the strobes of the request; nothing before, and when they never rose.
  [[nodiscard]] std::optional<Clock::time_point> raised_at() const noexcept;
  [[nodiscard]] bool is_done() const noexcept;
  /// @return time from strobe to FIN. Only when is_done().
  [[nodiscard]] Result take_result() noexcept;

 private:
  void run() noexcept;

  LogicTask& logic_task_;
  Notifier& notifier_;
  mutable std::mutex mutex_;
  std::condition_variable given_;
  std::optional<FunctionRequest> request_;
  std::optional<Clock::time_point> raised_at_;
  std::optional<Result> result_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace kernel_mocks
