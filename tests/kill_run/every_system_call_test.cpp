// A process that is killed at its first system call, at its second one, and so on until it comes to its end: what it
// leaves never stops the next ones, and goes with the segment.
//
// What changes outside of shared memory changes in a system call, so no moment in which named objects are made or removed
// is left out.

#include <gtest/gtest.h>

#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "protocol/hardened/master.hpp"
#include "protocol/hardened/slave.hpp"
#include "tests/kill_run/own_shared_memory.hpp"
#include "tests/kill_run/supervisor.hpp"

namespace kill_run {
namespace {

namespace hardened = protocol::hardened;
using namespace std::chrono_literals;

[[noreturn]] void run_traced(const std::function<void()>& body) {
  constexpr int not_allowed = 77;
  if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(not_allowed);
  ::raise(SIGSTOP);
  body();
  ::_exit(0);
}

enum class Ended { untouched, killed, cannot_be_traced };

/// Runs `body` in a process of its own.
/// @param stop  it is killed there, from 1: before its first system call, after it, before its second one ...
Ended run_until(unsigned stop, const std::function<void()>& body) {
  const pid_t process = ::fork();
  if (process == 0) run_traced(body);
  int status = 0;
  ::waitpid(process, &status, 0);
  if (!WIFSTOPPED(status)) return Ended::cannot_be_traced;
  for (unsigned stops = 0; WIFSTOPPED(status); ++stops) {
    if (stops == stop) ::kill(process, SIGKILL);
    ::ptrace(PTRACE_SYSCALL, process, nullptr, nullptr);
    ::waitpid(process, &status, 0);
  }
  return WIFSIGNALED(status) ? Ended::killed : Ended::untouched;
}

class KilledAtEverySystemCall : public testing::Test {
 protected:
  static void SetUpTestSuite() { owns_shared_memory_ = enter_own_shared_memory(); }

  KilledAtEverySystemCall() {
    run_.name = fmt::format("ltsim-every-call-{}", ::getpid());
    run_.owns_shared_memory = owns_shared_memory_;
    options_.take_timeout = 60s;
    options_.answer_timeout = 60s;
  }

  void exchange_and_remove() {
    hardened::Slave slave(run_.name, options_);
    ASSERT_TRUE(slave.open());
    hardened::Master master(run_.name, options_);
    ASSERT_TRUE(master.open());
    const std::array request{std::byte{1}, std::byte{2}};
    ASSERT_TRUE(master.write(request));
    ASSERT_TRUE(slave.wait_for_request());
    slave.write_response(slave.read_request());
    std::array<std::byte, 8> answer{};
    EXPECT_EQ(master.get_response(answer), request.size());
    master.close();
    slave.close();
    EXPECT_TRUE(hardened::remove_segment(run_.name));
    EXPECT_TRUE(named_objects(run_).empty()) << named_objects(run_).front();
  }

  /// @param prepare  what is there before the process that is killed
  void try_all(const std::function<void()>& prepare, const std::function<void()>& body) {
    for (unsigned stop = 1;; ++stop) {
      SCOPED_TRACE(fmt::format("killed at stop {}", stop));
      prepare();
      const Ended ended = run_until(stop, body);
      if (ended == Ended::cannot_be_traced) GTEST_SKIP() << "the system lets nobody be traced";
      ASSERT_NO_FATAL_FAILURE(exchange_and_remove());
      if (ended == Ended::untouched) {
        EXPECT_GT(stop, 20U) << "it has made hardly any system call";
        return;
      }
    }
  }

  void play_both() {
    hardened::Slave slave(run_.name, options_);
    ASSERT_TRUE(slave.open());
    hardened::Master master(run_.name, options_);
    ASSERT_TRUE(master.open());
  }

  RunOptions run_;
  hardened::Options options_;

 private:
  static inline bool owns_shared_memory_ = false;
};

TEST_F(KilledAtEverySystemCall, an_emulator_that_makes_the_segment_leaves_nothing) {
  try_all([] {},
          [this] {
            hardened::Slave slave(run_.name, options_);
            static_cast<void>(slave.open());
          });
}

TEST_F(KilledAtEverySystemCall, a_kernel_that_makes_the_segment_leaves_nothing) {
  try_all([] {},
          [this] {
            hardened::Master master(run_.name, options_);
            static_cast<void>(master.open());
          });
}

TEST_F(KilledAtEverySystemCall, a_kernel_that_opens_the_segment_and_asks_leaves_nothing) {
  hardened::Options impatient = options_;
  impatient.take_timeout = 0s;
  try_all([this] { play_both(); },
          [&] {
            hardened::Slave slave(run_.name, impatient);
            hardened::Master master(run_.name, impatient);
            if (!slave.open() || !master.open()) return;
            static_cast<void>(master.call({}, {}));
          });
}

TEST_F(KilledAtEverySystemCall, who_removes_the_segment_leaves_nothing) {
  try_all([this] { play_both(); }, [this] { static_cast<void>(hardened::remove_segment(run_.name)); });
}

}  // namespace
}  // namespace kill_run
