#include "sim_clock/explore/worker.hpp"

#include <chrono>
#include <csignal>
#include <thread>

#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/forked_work.hpp"
#include "sim_clock/explore/worker_message.hpp"

namespace ltsim {
namespace {

// For the signal handler, which gets no argument.
const World* world_at_work = nullptr;
WorkerProgress* progress_at_work = nullptr;

// An execution that counts may take several runs: to record it, to see whether it repeats.
void tell_position(int signal) {
  if (const pid_t process = ForkedWork::process(); process != 0) {
    kill(process, signal);  // the execution is there
    return;
  }
  const std::uint64_t execution = world_at_work->execution_number() + ForkedWork::processes_count();
  progress_at_work->position.store((execution << 40U) + world_at_work->scheduler().points(),
                                   std::memory_order_relaxed);
}

void answer_position_signal(const World& world, WorkerProgress& progress) {
  world_at_work = &world;
  progress_at_work = &progress;
  struct sigaction action{};
  action.sa_handler = &tell_position;
  action.sa_flags = SA_RESTART | SA_ONSTACK;  // no call of the code under test notices
  sigaction(worker_position_signal, &action, nullptr);
}

void send(int socket, const WorkerMessage& message) {
  write_all(socket, encode(message));  // if not, the parent is gone, and so are we in a moment
}

class Worker {
 public:
  Worker(const WorkerOrder& order, SharedProgress& progress, int socket)
      : order_(order), socket_(socket), bounds_(progress.bounds()), own_(progress.worker(order.number)) {
    answer_position_signal(world_, own_);
    world_.set_default_memory(order.options.memory);
    world_.set_default_cpu(order.options.cpu);
    world_.set_findings(order.options.findings);
    explorer_.set_start_state(order.options.start_state);
    if (order.scenario.prepare) order.scenario.prepare();
  }

  void run() {
    while (is_to_go_on()) {
      const std::uint64_t index = own_.ended.load(std::memory_order_relaxed);
      if (index - own_.taken.load(std::memory_order_acquire) == WorkerProgress::records_max) {
        std::this_thread::sleep_for(std::chrono::microseconds{100});
        continue;
      }
      own_.begun.store(index + 1, std::memory_order_relaxed);
      own_.record(index) = run_one(next_execution());
      own_.ended.store(index + 1, std::memory_order_release);
    }
  }

  [[nodiscard]] std::uint64_t next_execution() const {
    return order_.execution_of(own_.ended.load(std::memory_order_relaxed));
  }

 private:
  [[nodiscard]] bool is_to_go_on() const {
    return next_execution() <= bounds_.execution_last.load(std::memory_order_relaxed) &&
           !bounds_.stop.load(std::memory_order_relaxed);
  }

  ExecutionResult run_one(std::uint64_t execution) {
    std::optional<Failure> fresh;
    ExecutionResult result =
        explorer_.explore_one(order_.scenario, *strategy_, order_.options, execution, failures_, fresh);
    if (fresh) {
      result.failure = note(std::move(*fresh));
    } else if (result.failure != 0) {
      result.failure += order_.failures_sent;
    }
    return result;
  }

  /// @return its place, as records name it
  std::size_t note(Failure failure) {
    const std::uint64_t execution = failure.execution;
    const std::size_t new_place = order_.failures_sent + failures_.size() + 1;
    // As it is, before it is made small: that runs executions that nobody knows, and they may kill the worker.
    send(socket_, WorkerFoundFailure{.place = new_place, .failure = failure});
    if (!order_.options.keep_going) bounds_.end_at(execution);
    // Another worker may have found an earlier one: this one does not count then.
    if (execution > bounds_.execution_last.load()) return new_place;
    const std::size_t place = order_.failures_sent + explorer_.add_failure(order_.scenario, order_.options,
                                                                           failures_, std::move(failure));
    // The message first: who sees the record finds the failure there.
    if (place == new_place) send(socket_, WorkerFoundFailure{.place = place, .failure = failures_.back()});
    return place;
  }

  const WorkerOrder& order_;
  int socket_;
  ExplorationBounds& bounds_;
  WorkerProgress& own_;
  World world_;
  SignalGuard signals_;
  Explorer explorer_{world_};
  std::unique_ptr<Strategy> strategy_ = order_.make_strategy();
  std::vector<Failure> failures_;
};

/// @return the message with which the work ends
WorkerMessage work(const WorkerOrder& order, SharedProgress& progress, int socket) {
  Worker worker{order, progress, socket};
  try {
    worker.run();
    return WorkerFinished{};
  } catch (const Explorer::NotSimulable& error) {
    return WorkerGaveUp{.execution = worker.next_execution(), .message = error.message};
  } catch (const std::exception& error) {
    return WorkerGaveUp{.execution = worker.next_execution(),
                        .message = std::string{"internal error: "} + error.what()};
  }
}

}  // namespace

void run_worker(const WorkerOrder& order, SharedProgress& progress, int socket) noexcept {
  send(socket, work(order, progress, socket));
}

}  // namespace ltsim
