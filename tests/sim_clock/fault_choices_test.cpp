// Faults as choices: asked for where granted, within their budgets, written down and replayed.

#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>
#include <array>
#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "tests/sim_clock/faults_fixture.hpp"

namespace ltsim {
namespace {

using Bytes = std::array<std::atomic<unsigned char>, 16>;

/// Passes every place where a fault can strike. Some faults leave it waiting for ever.
void pass_every_place(World& world) {
  world.process("one").start("main", [] {
    auto& bytes = *static_cast<Bytes*>([] {
      const int descriptor = shm_open("/segment", O_CREAT | O_RDWR, 0600);
      if (descriptor < 0 || ftruncate(descriptor, 4096) != 0) return MAP_FAILED;
      return mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    }());
    if (&bytes == MAP_FAILED) return;
    for (auto& byte : bytes) ++byte;
    sem_post(open_semaphore());
  });
  world.process("two").start("main", [] {
    std::mutex mutex;
    std::condition_variable condition;
    bool called = false;
    sem_wait(open_semaphore());
    std::this_thread::sleep_for(1ms);
    const timespec deadline{.tv_sec = time(nullptr) + 1, .tv_nsec = 0};
    sem_timedwait(open_semaphore(), &deadline);
    std::thread caller{[&] {
      const std::lock_guard lock{mutex};
      called = true;
      condition.notify_one();
    }};
    std::unique_lock lock{mutex};
    while (!called) condition.wait(lock);
    lock.unlock();
    caller.join();
  });
  world.run();
}

void pass_every_place_with_all_faults(World& world) {
  for (const FaultKind kind : {FaultKind::lost_post, FaultKind::doubled_post, FaultKind::spurious_wake,
                               FaultKind::interrupt, FaultKind::clock_step, FaultKind::call_failure})
    world.grant(kind, 1);
  for (const FaultKind kind : {FaultKind::bit_flip, FaultKind::foreign_write})
    world.grant_in(kind, "segment", 0, 16, 1);
  for (const char* const name : {"one", "two"})
    world.process(name).may_crash({.times = 1, .restart_after = 1ms});
  world.process("two").may_stall(1);
  pass_every_place(world);
}

TEST_F(FaultsTest, every_kind_strikes_within_its_budget_and_what_was_recorded_replays) {
  std::map<FaultKind, std::size_t> struck;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Failure recorded = record_and_replay(seed, &pass_every_place_with_all_faults);
    if (HasFailure()) return;
    std::map<FaultKind, std::size_t> of_this;
    for (const Deviation& line : recorded.schedule.deviations) {
      if (line.kind == Deviation::Kind::fault) ++of_this[line.fault];
    }
    for (const auto& [kind, times] : of_this) {
      ASSERT_LE(times, kind == FaultKind::crash ? 2U : 1U) << seed << ": " << to_string(kind);
      struck[kind] += times;
    }
  }
  for (std::size_t i = 0; i < fault_kinds_count; ++i)
    EXPECT_GT(struck[static_cast<FaultKind>(i)], 0U) << to_string(static_cast<FaultKind>(i));
}

TEST_F(FaultsTest, nothing_is_asked_for_that_is_not_granted) {
  NeverStrikes strategy;
  EXPECT_EQ(run_under(strategy, 1, [](World& world) { pass_every_place(world); }), Outcome{});
}

TEST_F(FaultsTest, no_fault_strikes_in_the_fair_tail_of_an_execution_that_does_not_end) {
  class StrikesAlways final : public DefaultStrategy {
   public:
    [[nodiscard]] std::size_t strike(FaultKind /*kind*/, std::size_t /*variants*/) noexcept override {
      return 1;
    }
  } strategy;
  EXPECT_EQ(run_under(strategy, 1,
                      [](World& world) {
                        constexpr unsigned for_ever = 1'000'000;
                        world.grant(FaultKind::interrupt, for_ever);
                        world.set_points_max(1000);
                        world.process("p").start("main", [] {
                          timespec left{.tv_sec = 1, .tv_nsec = 0};
                          while (nanosleep(&left, &left) != 0) {
                          }
                        });
                      }),
            Outcome{});
}

}  // namespace
}  // namespace ltsim
