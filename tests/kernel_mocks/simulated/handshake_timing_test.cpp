// The times of the handshake: TMF from the code to its strobe, TFIN for which FIN must stay on.
#include "tests/kernel_mocks/simulated/simulated_kernel.hpp"

namespace kernel_mocks {
namespace {

class HandshakeTiming : public SimulatedKernel {};

TEST_F(HandshakeTiming, without_tmf_the_strobe_follows_its_code_at_once) {
  ASSERT_EQ(run_program("M8\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(plc.time_of(m_strobe) - plc.time_of("D100 = 8 0 0"), 1ms);
}

TEST_F(HandshakeTiming, with_tmf_the_strobe_follows_its_code_after_just_that_time) {
  logic.tmf = 16ms;
  ASSERT_EQ(run_program("M8\nM30").outcome, RunOutcome::ended);
  const auto waited = plc.time_of(m_strobe) - plc.time_of("D100 = 8 0 0");
  EXPECT_GE(waited, 16ms);
  EXPECT_LT(waited, 17ms);
}

TEST_F(HandshakeTiming, without_tfin_a_fin_that_one_poll_sees_counts) {
  // The strobe falls with the poll after the one that sees FIN: FIN, on for one poll only, is off by then.
  plc.fin = [](auto since) { return since && *since >= 20ms && *since < 21ms; };
  ASSERT_EQ(run_program("M8\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(plc.time_of(den_on) - plc.time_of(m_strobe), 25ms);
}

TEST_F(HandshakeTiming, with_tfin_a_shorter_fin_is_ignored_and_a_longer_one_counts) {
  logic.tfin = 16ms;
  plc.fin = [](auto since) { return since && ((*since >= 20ms && *since < 35ms) || *since >= 60ms); };
  ASSERT_EQ(run_program("M8\nM30").outcome, RunOutcome::ended);
  const auto strobe_fell = plc.time_of(den_on) - plc.time_of(m_strobe);
  EXPECT_GE(strobe_fell, 76ms);
  EXPECT_LT(strobe_fell, 80ms);
}

TEST_F(HandshakeTiming, with_tfin_a_fin_that_drops_early_begins_anew) {
  logic.tfin = 16ms;
  // On for 10 ms, off for 5 ms, on for 10 ms: together more than TFIN, and never TFIN at a stretch until 50 ms.
  plc.fin = [](auto since) { return since && (*since >= 50ms || *since % 15ms < 10ms); };
  ASSERT_EQ(run_program("M8\nM30").outcome, RunOutcome::ended);
  const auto strobe_fell = plc.time_of(den_on) - plc.time_of(m_strobe);
  EXPECT_GE(strobe_fell, 61ms);
  EXPECT_LT(strobe_fell, 70ms);
}

TEST_F(HandshakeTiming, a_fin_that_is_never_on_for_tfin_is_missing) {
  logic.tfin = 16ms;
  logic.fin_timeout = 500ms;
  plc.fin = [](auto since) { return since && *since % 15ms < 10ms; };
  const RunResult result = run_program("M8\nM30");
  ASSERT_TRUE(result.failure.has_value());
  EXPECT_EQ(result.failure->fault, LogicFault::fin_missing);
}

TEST_F(HandshakeTiming, a_fin_that_is_on_before_the_strobe_delays_the_code_until_it_has_been_off) {
  plc.port.set_bit(120, true);
  plc.fin = [this](auto since) {
    if (since) return true;
    return plc.count_of("D100 = 8 0 0") == 0 && plc.port.polls < 40;
  };
  ASSERT_EQ(run_program("M8\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.time_of("D100 = 8 0 0"), 35ms);
}

TEST_F(HandshakeTiming, the_next_function_waits_until_fin_has_been_off) {
  // FIN stays 30 ms longer than the strobe.
  std::chrono::steady_clock::time_point last_strobe;
  plc.fin = [&](auto since) {
    const auto now = std::chrono::steady_clock::now();
    if (since) last_strobe = now;
    return plc.count_of(m_strobe) > 0 && now - last_strobe < 30ms;
  };
  ASSERT_EQ(run_program("M8\nM9\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.time_of("D100 = 9 0 0") - plc.time_of(den_on), 29ms);
}

TEST_F(HandshakeTiming, several_m_functions_of_a_block_have_a_handshake_each) {
  ASSERT_EQ(run_program("S900 M3 M8 M10\nM30").outcome, RunOutcome::ended);
  const std::vector<std::string> expected{"D100 = 3 900 0",  "M96 byte B0", "M96 byte 80",
                                          "D100 = 8 900 0",  "M96 byte 90", "M96 byte 80",
                                          "D100 = 10 900 0", "M96 byte 90", "M96 byte 80"};
  const auto begin = std::ranges::find(plc.port.log, expected.front());
  ASSERT_GE(plc.port.log.end() - begin, 9);
  EXPECT_EQ(std::vector<std::string>(begin, begin + 9), expected);
}

TEST_F(HandshakeTiming, the_time_out_for_fin_is_kept_to_the_poll) {
  logic.fin_timeout = 200ms;
  plc.fin = [](auto) { return false; };
  const RunResult result = run_program("M8\nM30");
  ASSERT_TRUE(result.failure.has_value());
  EXPECT_EQ(result.failure->fault, LogicFault::fin_missing);
  EXPECT_GE(result.failure->after, 200ms);
  EXPECT_LT(result.failure->after, 202ms);
}

}  // namespace
}  // namespace kernel_mocks
