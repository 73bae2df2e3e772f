#include "kernel_mocks/function_worker.hpp"

#include <utility>

#include "protocol/check.hpp"

namespace kernel_mocks {

FunctionWorker::FunctionWorker(LogicTask& logic_task, Notifier& notifier)
    : logic_task_{logic_task}, notifier_{notifier}, thread_{[this] { run(); }} {}

FunctionWorker::~FunctionWorker() { stop(); }

void FunctionWorker::stop() noexcept {
  {
    const std::scoped_lock lock{mutex_};
    stopping_ = true;
    if (request_) logic_task_.abort();
  }
  given_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void FunctionWorker::give(const FunctionRequest& request) noexcept {
  {
    const std::scoped_lock lock{mutex_};
    PLC_CHECK(!request_ && !result_);
    request_ = request;
    raised_at_.reset();
  }
  given_.notify_one();
}

std::optional<FunctionWorker::Clock::time_point> FunctionWorker::raised_at() const noexcept {
  const std::scoped_lock lock{mutex_};
  return raised_at_;
}

bool FunctionWorker::is_done() const noexcept {
  const std::scoped_lock lock{mutex_};
  return result_.has_value();
}

FunctionWorker::Result FunctionWorker::take_result() noexcept {
  const std::scoped_lock lock{mutex_};
  PLC_CHECK(result_.has_value());
  return *std::exchange(result_, std::nullopt);
}

void FunctionWorker::run() noexcept {
  std::unique_lock lock{mutex_};
  for (;;) {
    given_.wait(lock, [this] { return stopping_ || request_; });
    if (stopping_) return;
    const FunctionRequest request = *request_;
    lock.unlock();
    const auto raised = logic_task_.raise(request);
    if (raised) {
      lock.lock();
      raised_at_ = Clock::now();
      lock.unlock();
      notifier_.notify();
    }
    Result result = raised ? logic_task_.acknowledge() : tl::unexpected{raised.error()};
    lock.lock();
    result_ = std::move(result);
    request_.reset();
    lock.unlock();
    notifier_.notify();
    lock.lock();
  }
}

}  // namespace kernel_mocks
