// The programs of this folder, explored as a stranger does it: each bug is found, as the README says that it shows, and its schedule fails
// again; the correct twin is silent.

#include <iterator>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/programs/explore_test.hpp"

namespace {

using program_tests::Result;

struct Program {
  std::string_view name;
  std::string_view outcomes;  ///< one of these words; which, depends on the seed
  std::string_view options = "";
  /// False: it looks at a frame that is gone, where the simulator's own functions have been since; how that ends may differ.
  bool ends_alike = true;
};

void PrintTo(const Program& program, std::ostream* out) { *out << program.name; }

constexpr Program programs[] = {
    {"aba_stack", "assertion"},
    {"atomic_two_steps", "exit"},
    {"atomic_wait_missed", "deadlock"},
    {"bank_transfer", "exit"},
    {"barrier_reuse", "deadlock"},
    {"barrier_wrong_count", "assertion exit deadlock"},
    {"bit_field_two_locks", "data-race"},
    {"cache_leak", "leak"},
    {"condition_if", "assertion"},
    {"deadlock_three_locks", "deadlock"},
    {"deadlock_two_locks", "deadlock"},
    {"dekker_relaxed", "assertion", "--memory c11"},
    {"detached_stack_frame", "exit data-race crash", "", false},
    {"dining_philosophers", "deadlock"},
    {"double_checked_locking", "data-race"},
    {"double_close", "crash"},
    {"early_return", "deadlock"},
    {"empty_then_take", "crash"},
    {"exception_with_lock", "deadlock"},
    {"exit_status_order", "exit"},
    {"half_built", "data-race exit"},
    {"jthread_stop", "deadlock"},
    {"latch_before_store", "exit"},
    {"lazy_init", "data-race leak"},
    {"listener_snapshot", "data-race crash"},
    {"lookup_then_ref", "crash"},
    {"lost_signal", "deadlock"},
    {"one_condition_buffer", "deadlock"},
    {"message_queue_two_steps", "deadlock"},
    {"pool_shutdown", "exit"},
    {"promise_twice", "crash"},
    {"publish_relaxed", "data-race"},
    {"queue_done_too_soon", "exit"},
    {"readers_count", "deadlock"},
    {"refcount_plain", "data-race"},
    {"refcount_two_steps", "data-race crash"},
    {"request_completion", "crash"},
    {"ring_off_by_one", "exit"},
    {"rwlock_upgrade", "deadlock exit"},
    {"semaphore_initial_count", "assertion"},
    {"seqlock_no_retry", "exit"},
    {"shm_mailbox", "exit"},
    {"spin_average", "exit assertion"},
    {"spin_test_then_set", "data-race exit"},
    {"spsc_two_producers", "data-race exit"},
    {"stack_two_poppers", "data-race"},
    {"start_before_store", "crash"},
    {"start_gate", "deadlock"},
    {"static_local_counter", "data-race assertion"},
    {"stop_flag", "assertion"},
    {"system_v_half_made", "deadlock"},
    {"thread_key_destructor", "data-race crash"},
    {"timed_lock_ignored", "assertion data-race exit"},
    {"torn_pair", "data-race"},
    {"torn_pair_checker", "assertion"},
    {"torn_pair_two_locks", "exit"},
    {"trylock_unlock", "exit"},
    {"turns", "deadlock exit"},
    {"two_stage", "assertion"},
    {"two_tokens", "deadlock"},
    {"vector_push_back", "data-race crash"},
    {"work_stealing_fence", "exit", "--memory c11"},
    {"work_stealing_order", "exit"},
    {"wrong_lock", "data-race"},
};
class ProgramTest : public program_tests::ExploreTest, public testing::WithParamInterface<Program> {};

TEST_P(ProgramTest, shows_its_bug_and_shows_it_again) {
  const std::string name{GetParam().name};
  const Result found =
      ltsim("explore --executions 10000 " + std::string{GetParam().options} + " -- " + path_of(name));
  ASSERT_EQ(found.exit_code, 1) << found.output;
  const std::size_t begin = found.output.find("\n" + name + "  ");
  ASSERT_NE(begin, std::string::npos) << found.output;
  const std::size_t outcome = begin + 1 + name.size() + 2;
  const std::string kind = found.output.substr(outcome, found.output.find(':', outcome) - outcome);
  EXPECT_NE((" " + std::string{GetParam().outcomes} + " ").find(" " + kind + " "), std::string::npos)
      << found.output;
  const Result again = ltsim("replay out/" + name + ".schedule");
  EXPECT_EQ(again.exit_code, 1) << again.output;
  EXPECT_EQ(contains(again, "not as recorded") && GetParam().ends_alike, false) << again.output;
}

TEST_P(ProgramTest, is_silent_where_it_is_correct) {
  const Result result = ltsim("explore --executions 1000 " + std::string{GetParam().options} + " -- " +
                              path_of(std::string{GetParam().name} + "-corrected"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

/// All but those that this build does without.
std::vector<Program> programs_built() {
  std::vector<Program> built{std::begin(programs), std::end(programs)};
  std::istringstream left_out{PROGRAMS_LEFT_OUT};
  for (std::string name; left_out >> name;)
    std::erase_if(built, [&](const Program& each) { return each.name == name; });
  return built;
}

INSTANTIATE_TEST_SUITE_P(All, ProgramTest, testing::ValuesIn(programs_built()),
                         [](const auto& test) { return std::string{test.param.name}; });

}  // namespace
