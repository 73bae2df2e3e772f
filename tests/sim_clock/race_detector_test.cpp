// Data races across processes: what orders two accesses and what does not. In each case the tasks run one
// after the other, so that what is found is found by what the code says, not by luck.

#include <condition_variable>
#include <cstddef>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>

#include "tests/sim_clock/races_fixture.hpp"

namespace ltsim {
namespace {

// --- which accesses ---

TEST_F(RaceDetectorTest, a_write_and_a_read_race_whichever_comes_first) {
  EXPECT_EQ(kind_of({[](Memory& m) { write(m.value); }, [](Memory& m) { read(m.value); }}), race);
  EXPECT_EQ(kind_of({[](Memory& m) { read(m.value); }, [](Memory& m) { write(m.value); }}), race);
}

TEST_F(RaceDetectorTest, two_writes_race) {
  EXPECT_EQ(kind_of({[](Memory& m) { write(m.value); }, [](Memory& m) { write(m.value); }}), race);
}

TEST_F(RaceDetectorTest, two_reads_do_not_race) {
  EXPECT_EQ(kind_of({[](Memory& m) { read(m.value); }, [](Memory& m) { read(m.value); }}), ordered);
}

TEST_F(RaceDetectorTest, one_task_does_not_race_with_itself) {
  EXPECT_EQ(kind_of({[](Memory& m) {
              write(m.value);
              read(m.value);
              write(m.value);
            }}),
            ordered);
}

TEST_F(RaceDetectorTest, volatile_orders_nothing) {
  EXPECT_EQ(kind_of({[](Memory& m) { static_cast<volatile int&>(m.value) = 1; },
                     [](Memory& m) { seen = static_cast<volatile int&>(m.value); }}),
            race);
}

TEST_F(RaceDetectorTest, neighbouring_bytes_do_not_race) {
  EXPECT_EQ(kind_of({[](Memory& m) { write(m.bytes[0]); }, [](Memory& m) { write(m.bytes[1]); }}), ordered);
}

TEST_F(RaceDetectorTest, accesses_of_different_widths_race_where_they_overlap) {
  const Body write_four = [](Memory& m) { write(reinterpret_cast<int&>(m.bytes[4])); };
  EXPECT_EQ(kind_of({write_four, [](Memory& m) { read(m.bytes[7]); }}), race);
  EXPECT_EQ(kind_of({write_four, [](Memory& m) { read(m.bytes[8]); }}), ordered);
  EXPECT_EQ(kind_of({write_four, [](Memory& m) { read(m.bytes[3]); }}), ordered);
}

TEST_F(RaceDetectorTest, an_access_across_eight_bytes_races_at_both_ends) {
  static_assert(offsetof(Memory, bytes) == 4);
  const Body write_four = [](Memory& m) { write(reinterpret_cast<int&>(m.bytes[2])); };  // bytes 6 to 9
  EXPECT_EQ(kind_of({write_four, [](Memory& m) { read(m.bytes[2]); }}), race);
  EXPECT_EQ(kind_of({write_four, [](Memory& m) { read(m.bytes[5]); }}), race);
  EXPECT_EQ(kind_of({write_four, [](Memory& m) { read(m.bytes[6]); }}), ordered);
}

TEST_F(RaceDetectorTest, every_piece_of_a_copy_is_an_access) {
  const Body copy_into = [](Memory& m) {
    const std::array<unsigned char, 20> source{};
    std::memcpy(m.bytes.data(), source.data(), source.size());
  };
  EXPECT_EQ(kind_of({copy_into, [](Memory& m) { read(m.bytes[19]); }}), race);
  EXPECT_EQ(kind_of({copy_into, [](Memory& m) { read(m.bytes[20]); }}), ordered);
  const Body copy_out_of = [](Memory& m) {
    std::array<unsigned char, 20> target{};
    std::memcpy(target.data(), m.bytes.data(), target.size());
    seen = target[3];
  };
  EXPECT_EQ(kind_of({copy_out_of, [](Memory& m) { write(m.bytes[17]); }}), race);
  EXPECT_EQ(kind_of({copy_out_of, [](Memory& m) { read(m.bytes[17]); }}), ordered);
}

TEST_F(RaceDetectorTest, two_mappings_in_one_process_show_the_same_bytes) {
  const Outcome outcome = run_alone([](Memory& memory) {
    auto& again = *static_cast<Memory*>(map_segment());
    ASSERT_NE(&again, &memory);
    std::thread writer{[&again] { write(again.value); }};
    read(memory.value);
    writer.join();
  });
  EXPECT_EQ(outcome.kind, race);
}

TEST_F(RaceDetectorTest, an_old_access_is_not_forgotten_for_a_newer_one_of_another_task) {
  EXPECT_EQ(kind_of({[](Memory& m) { read(m.value); }, [](Memory& m) { read(m.value); },
                     [](Memory& m) {
                       seen = m.flag.load();  // comes after nothing
                       write(m.value);
                     }}),
            race);
}

// --- atomics ---

TEST_F(RaceDetectorTest, atomics_do_not_race_with_each_other) {
  EXPECT_EQ(kind_of({[](Memory& m) { m.flag.store(1, std::memory_order_relaxed); },
                     [](Memory& m) { m.flag.fetch_add(1, std::memory_order_relaxed); },
                     [](Memory& m) { seen = m.flag.load(std::memory_order_relaxed); }}),
            ordered);
}

TEST_F(RaceDetectorTest, an_atomic_races_with_a_plain_access) {
  EXPECT_EQ(
      kind_of({[](Memory& m) { m.flag.store(1); }, [](Memory& m) { read(reinterpret_cast<int&>(m.flag)); }}),
      race);
  EXPECT_EQ(kind_of({[](Memory& m) { write(reinterpret_cast<int&>(m.flag)); },
                     [](Memory& m) { seen = m.flag.load(); }}),
            race);
  EXPECT_EQ(kind_of({[](Memory& m) { read(reinterpret_cast<int&>(m.flag)); },
                     [](Memory& m) { seen = m.flag.load(); }}),
            ordered);
}

TEST_F(RaceDetectorTest, a_compare_and_exchange_that_fails_is_a_load) {
  const Body exchange = [](Memory& m) {
    int expected = 5;
    seen = m.flag.compare_exchange_strong(expected, 6) ? 1 : 0;
  };
  EXPECT_EQ(kind_of({[](Memory& m) { read(reinterpret_cast<int&>(m.flag)); }, exchange}), ordered);
  EXPECT_EQ(kind_of({[](Memory& m) { write(reinterpret_cast<int&>(m.flag)); }, exchange}), race);
}

struct Orders {
  std::memory_order store;
  std::memory_order load;
  OutcomeKind outcome;
};

class StoreAndLoadTest : public RaceDetectorTest, public testing::WithParamInterface<Orders> {};

// The order has to be a constant where it is used: otherwise the compiler takes the strongest.
void store(std::atomic<int>& flag, std::memory_order order) {
  switch (order) {
    case std::memory_order_relaxed:
      return flag.store(1, std::memory_order_relaxed);
    case std::memory_order_release:
      return flag.store(1, std::memory_order_release);
    default:
      return flag.store(1, std::memory_order_seq_cst);
  }
}

int load(const std::atomic<int>& flag, std::memory_order order) {
  switch (order) {
    case std::memory_order_relaxed:
      return flag.load(std::memory_order_relaxed);
    case std::memory_order_acquire:
      return flag.load(std::memory_order_acquire);
    default:
      return flag.load(std::memory_order_seq_cst);
  }
}

TEST_P(StoreAndLoadTest, hands_over_what_its_orders_say) {
  EXPECT_EQ(message_passing([](Memory& m) { store(m.flag, GetParam().store); },
                            [](Memory& m) { seen = load(m.flag, GetParam().load); }),
            GetParam().outcome);
}

INSTANTIATE_TEST_SUITE_P(
    MemoryOrder, StoreAndLoadTest,
    testing::Values(Orders{std::memory_order_release, std::memory_order_acquire, ordered},
                    Orders{std::memory_order_seq_cst, std::memory_order_seq_cst, ordered},
                    Orders{std::memory_order_seq_cst, std::memory_order_acquire, ordered},
                    Orders{std::memory_order_release, std::memory_order_seq_cst, ordered},
                    Orders{std::memory_order_relaxed, std::memory_order_acquire, race},
                    Orders{std::memory_order_release, std::memory_order_relaxed, race},
                    Orders{std::memory_order_relaxed, std::memory_order_relaxed, race}));

TEST_F(RaceDetectorTest, what_follows_a_release_is_not_handed_over) {
  EXPECT_EQ(kind_of({[](Memory& m) {
                       m.flag.store(1, std::memory_order_release);
                       write(m.value);
                     },
                     [](Memory& m) {
                       seen = m.flag.load(std::memory_order_acquire);
                       read(m.value);
                     }}),
            race);
}

TEST_F(RaceDetectorTest, another_place_hands_nothing_over) {
  EXPECT_EQ(
      message_passing([](Memory& m) { m.flag.store(1); }, [](Memory& m) { seen = m.other_flag.load(); }),
      race);
}

TEST_F(RaceDetectorTest, an_update_goes_on_with_a_release_and_a_store_ends_it) {
  const Body writer = [](Memory& m) {
    write(m.value);
    m.flag.store(1, std::memory_order_release);
  };
  const Body reader = [](Memory& m) {
    seen = m.flag.load(std::memory_order_acquire);
    read(m.value);
  };
  EXPECT_EQ(kind_of({writer, [](Memory& m) { m.flag.fetch_add(1, std::memory_order_relaxed); }, reader}),
            ordered);
  EXPECT_EQ(kind_of({writer, [](Memory& m) { m.flag.store(2, std::memory_order_relaxed); }, reader}), race);
}

TEST_F(RaceDetectorTest, a_relaxed_update_receives_nothing_and_an_acquiring_one_does) {
  const Body release = [](Memory& m) { m.flag.store(1, std::memory_order_release); };
  EXPECT_EQ(message_passing(release, [](Memory& m) { m.flag.exchange(2, std::memory_order_acquire); }),
            ordered);
  EXPECT_EQ(message_passing(release, [](Memory& m) { m.flag.exchange(2, std::memory_order_release); }), race);
}

TEST_F(RaceDetectorTest, a_failed_exchange_receives_by_its_failure_order) {
  const Body release = [](Memory& m) { m.flag.store(1, std::memory_order_release); };
  int expected = 7;
  EXPECT_EQ(message_passing(release,
                            [&](Memory& m) {
                              m.flag.compare_exchange_strong(expected, 2, std::memory_order_acq_rel,
                                                             std::memory_order_acquire);
                            }),
            ordered);
  expected = 7;
  EXPECT_EQ(message_passing(release,
                            [&](Memory& m) {
                              m.flag.compare_exchange_strong(expected, 2, std::memory_order_acq_rel,
                                                             std::memory_order_relaxed);
                            }),
            race);
}

TEST_F(RaceDetectorTest, fences_make_relaxed_accesses_hand_over) {
  const Body relaxed_store = [](Memory& m) { m.flag.store(1, std::memory_order_relaxed); };
  const Body relaxed_load = [](Memory& m) { seen = m.flag.load(std::memory_order_relaxed); };
  const Body fenced_store = [](Memory& m) {
    std::atomic_thread_fence(std::memory_order_release);
    m.flag.store(1, std::memory_order_relaxed);
  };
  const Body fenced_load = [](Memory& m) {
    seen = m.flag.load(std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_acquire);
  };
  EXPECT_EQ(message_passing(fenced_store, fenced_load), ordered);
  EXPECT_EQ(message_passing(relaxed_store, fenced_load), race);
  EXPECT_EQ(message_passing(fenced_store, relaxed_load), race);
}

TEST_F(RaceDetectorTest, a_fence_on_the_wrong_side_of_its_access_is_none) {
  EXPECT_EQ(message_passing([](Memory& m) { m.flag.store(1, std::memory_order_release); },
                            [](Memory& m) {
                              std::atomic_thread_fence(std::memory_order_acquire);
                              seen = m.flag.load(std::memory_order_relaxed);
                            }),
            race);
  EXPECT_EQ(kind_of({[](Memory& m) {
                       std::atomic_thread_fence(std::memory_order_release);
                       write(m.value);
                       m.flag.store(1, std::memory_order_relaxed);
                     },
                     [](Memory& m) {
                       seen = m.flag.load(std::memory_order_acquire);
                       read(m.value);
                     }}),
            race);
}

TEST_F(RaceDetectorTest, an_atomic_of_the_process_orders_accesses_to_a_segment) {
  std::atomic<int> flag = 0;
  EXPECT_EQ(message_passing([&](Memory&) { flag.store(1, std::memory_order_release); },
                            [&](Memory&) { seen = flag.load(std::memory_order_acquire); }),
            ordered);
}

// --- the outcome ---

TEST_F(RaceDetectorTest, the_message_names_both_accesses_by_task_place_and_line) {
  int write_line = 0;
  int read_line = 0;
  const Body writer = [&](Memory& m) {
    write_line = __LINE__ + 1;
    m.bytes[3] = 1;
  };
  const Body reader = [&](Memory& m) {
    read_line = __LINE__ + 1;
    seen = m.bytes[3];
  };
  const auto message = [&](const char* writing_task, const char* reading_task) {
    const std::string file = "tests/sim_clock/race_detector_test.cpp:";
    return std::string{writing_task} + " writes segment.bytes[3] at " + file + std::to_string(write_line) +
           " while " + reading_task + " reads it at " + file + std::to_string(read_line) +
           ", and nothing orders the two";
  };
  Outcome outcome = run_in_turn({writer, reader});
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::data_race, message("a/main", "b/main")}));
  outcome = run_in_turn({reader, writer});
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::data_race, message("b/main", "a/main")}));
}

TEST_F(RaceDetectorTest, an_atomic_is_named_by_the_line_that_uses_it_and_not_by_one_of_its_header) {
  int line = 0;
  const Outcome outcome = run_in_turn({[](Memory& m) { read(reinterpret_cast<int&>(m.flag)); },
                                       [&line](Memory& m) {
                                         line = __LINE__ + 1;
                                         m.flag.store(1, std::memory_order_relaxed);
                                       }});
  const std::string wanted =
      "b/main atomically writes segment[32] at tests/sim_clock/race_detector_test.cpp:" +
      std::to_string(line) + " while a/main reads it at ";
  EXPECT_TRUE(outcome.message.starts_with(wanted)) << outcome.message;
}

TEST_F(RaceDetectorTest, a_copy_is_named_by_the_line_that_calls_it) {
  int line = 0;
  const Outcome outcome = run_in_turn({[](Memory& m) { read(m.bytes[0]); },
                                       [&line](Memory& m) {
                                         line = __LINE__ + 1;
                                         std::memset(m.bytes.data(), 1, m.bytes.size());
                                       }});
  EXPECT_NE(outcome.message.find("race_detector_test.cpp:" + std::to_string(line) + " while"),
            std::string::npos)
      << outcome.message;
}

TEST_F(RaceDetectorTest, a_stronger_failure_of_the_same_execution_is_the_outcome) {
  const Body racing = [](Memory& m) {
    read(m.value);
    write(m.value);
  };
  const Outcome outcome = run_in_turn({racing, [&](Memory& m) {
                                         racing(m);
                                         world().violated("a part was not counted");
                                       }});
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::invariant, "a part was not counted"}));
}

TEST_F(RaceDetectorTest, a_scenario_that_allows_races_passes_and_the_next_one_does_not) {
  const Body racing = [](Memory& m) { write(m.value); };
  EXPECT_EQ(kind_of({[&](Memory& m) {
                       world().allow_data_races();
                       racing(m);
                     },
                     racing}),
            OutcomeKind::passed);
  EXPECT_EQ(kind_of({racing, racing}), race);
}

TEST_F(RaceDetectorTest, nothing_is_checked_when_the_checks_are_off) {
  const Body racing = [](Memory& m) { write(m.value); };
  world().set_checks(false);
  EXPECT_EQ(kind_of({racing, racing}), OutcomeKind::passed);
  world().set_checks(true);
  EXPECT_EQ(kind_of({racing, racing}), race);
}

TEST_F(RaceDetectorTest, nothing_is_left_over_from_the_last_execution) {
  EXPECT_EQ(kind_of({[](Memory& m) { write(m.value); }}), OutcomeKind::passed);
  EXPECT_EQ(kind_of({[](Memory&) {}, [](Memory& m) { write(m.value); }}), OutcomeKind::passed);
}

}  // namespace
}  // namespace ltsim
