// The configuration is good as a whole or refused as a whole, and may change while the PLC works.
#include "emulator_models/soft_plc/plc_configuration.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <map>
#include <thread>

#include "emulator_models/soft_plc/configured_plc.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;

const std::string good =
    "[plc]\n"
    "threads = \"per-cycle\"\n"
    "[[cycle]]\n"
    "name = \"a\"\n"
    "program = \"a.il\"\n"
    "period_ms = 1\n";
const std::string program = "PROGRAM p\nVAR w AT %MW8 : INT; END_VAR\nLD w\nADD 1\nST w\nEND_PROGRAM\n";

std::optional<std::string> read_source(const std::string& path) {
  const std::map<std::string, std::string> files{
      {"dir/a.il", program}, {"dir/b.il", program}, {"dir/bad.il", "PROGRAM p\nADD 1\nEND_PROGRAM\n"}};
  const auto found = files.find(path);
  return found == files.end() ? std::nullopt : std::optional{found->second};
}

std::string refusal(const std::string& text) {
  const auto parsed = parse_configuration(text, "dir/plc.toml", read_source);
  return parsed ? "taken" : parsed.error();
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(PlcConfiguration, what_is_left_out_has_its_default) {
  const auto parsed = parse_configuration(good, "dir/plc.toml", read_source).value();
  EXPECT_EQ(parsed.threading, PlcThreading::per_cycle);
  EXPECT_EQ(parsed.cycles[0].config.scan.watchdog_limit, 150ms);
  EXPECT_EQ(parsed.cycles[0].config.scan.overrun, OverrunRule::skip);
  EXPECT_EQ(parsed.gateway.queue_max, 32U);
  EXPECT_TRUE(parsed.archive.path.empty());
}

TEST(PlcConfiguration, keys_within_keys_without_end_are_refused_and_do_not_overflow_the_stack) {
  std::string keys;
  for (int i = 0; i < 300'000; ++i) keys += "a.";
  EXPECT_EQ(refusal(good + keys + "a = 1\n"),
            "dir/plc.toml:7:16: this nests deeper than 8 levels; no key here needs as many");
}

TEST(PlcConfiguration, each_mistake_is_refused_with_its_place_and_the_way_out) {
  EXPECT_EQ(
      refusal(good + "periode_ms = 1\n"),
      "dir/plc.toml:7:1: [[cycle]] has no key periode_ms; known here: name, overrun, period_ms, priority, "
      "program, sends, watchdog_ms");
  EXPECT_EQ(refusal(replaced(good, "= 1", "= \"1\"")),
            "dir/plc.toml:6:13: period_ms must be an integer from 0 to 3600000");
  EXPECT_EQ(refusal(good + "watchdog_ms = 0\n"),
            "dir/plc.toml:7:15: watchdog_ms must be an integer from 1 to 3600000");
  EXPECT_EQ(refusal(good + "overrun = \"wait\"\n"),
            "dir/plc.toml:7:11: overrun must be one of \"skip\", \"stop\", \"catch-up\"");
  EXPECT_EQ(refusal(replaced(good, "a.il", "none.il")),
            "dir/plc.toml:5:11: dir/none.il cannot be read; check the path, which is relative to this file");
  EXPECT_EQ(refusal(replaced(good, "a.il", "bad.il"))
                .rfind("dir/plc.toml:5:11: does not compile: dir/bad.il:2:", 0),
            0U);
  EXPECT_EQ(refusal(good + "= 3\n").rfind("dir/plc.toml:7:1: ", 0), 0U);
  EXPECT_EQ(refusal(good + "[archive]\nsignals = [\"%QZ1\"]\n").rfind("dir/plc.toml:8:11: %QZ1: ", 0), 0U);
  EXPECT_EQ(refusal(good + "[archive]\nsignals = [\"%MW9\"]\n"),
            "dir/plc.toml:8:11: %MW9 is no bit; the archive has changes of bits, as \"%QX0.3\"");
  EXPECT_EQ(refusal("[plc]\n").rfind("dir/plc.toml:1:1: a PLC has 1 to 32 cycles", 0), 0U);
}

TEST(PlcConfiguration, fixed_inputs_are_bytes_of_a_simulated_driver_and_no_more_than_its_inputs) {
  const auto with = [](const std::string& kind, const std::string& values) {
    return good + "[[driver]]\nname = \"d\"\nkind = \"" + kind +
           "\"\nperiod_ms = 1\ninputs = { first_byte = 0, bytes = 2 }\nfixed_inputs = [" + values + "]\n";
  };
  EXPECT_EQ(refusal(with("simulated", "1, 255")), "taken");
  EXPECT_EQ(refusal(with("simulated", "1, 2, 3")),
            "dir/plc.toml:12:16: fixed_inputs has 3 bytes, but inputs only 2");
  EXPECT_EQ(refusal(with("propulsion", "1")),
            "dir/plc.toml:12:16: fixed_inputs belongs to kind \"simulated\"; leave it out");
  EXPECT_NE(refusal(with("simulated", "256")).find("from 0 to 255"), std::string::npos);
}

TEST(PlcConfiguration,
     a_program_that_writes_a_word_of_another_cycle_is_refused_with_the_line_of_the_program) {
  const std::string two = good + "[[cycle]]\nname = \"b\"\nprogram = \"b.il\"\nperiod_ms = 1\n";
  EXPECT_EQ(refusal(two), "taken");
  EXPECT_EQ(refusal(two + "sends = { first_word = 8, words = 1 }\n"),
            "dir/plc.toml:5:11: dir/a.il:5:1: writes a word that cycle b sends; only its owner may write it");
}

const std::string cycle_b = "[[cycle]]\nname = \"b\"\nprogram = \"b.il\"\nperiod_ms = 1\n";
std::string driver(const std::string& name, const std::string& keys) {
  std::string text{"[[driver]]\nname = \""};
  text += name;
  text += "\"\nkind = \"x\"\nperiod_ms = 1\n";
  return text += keys;
}

TEST(PlcConfiguration, names_are_unique_among_cycles_and_among_drivers) {
  EXPECT_EQ(refusal(good + replaced(cycle_b, "\"b\"", "\"a\"")),
            "dir/plc.toml:8:8: there is a cycle a already; names are unique");
  EXPECT_EQ(refusal(good + driver("d", {}) + driver("d", {})),
            "dir/plc.toml:12:8: there is a driver d already; names are unique");
  EXPECT_EQ(refusal(good + driver("a", {})), "taken");
}

TEST(PlcConfiguration, words_and_inputs_have_one_owner_and_lie_within_their_area) {
  const std::string sends = "sends = { first_word = 100, words = 2 }\n";
  EXPECT_EQ(
      refusal(good + sends + cycle_b + replaced(sends, "100", "101")),
      "dir/plc.toml:12:9: cycle a sends some of these words; each word has one owner, move one of them");
  EXPECT_EQ(refusal(good + sends + cycle_b + replaced(sends, "100", "102")), "taken");
  EXPECT_EQ(refusal(good + "sends = { first_word = 8191, words = 2 }\n"),
            "dir/plc.toml:7:9: sends ends beyond the area, which has 8192 words");
  const std::string inputs = "inputs = { first_byte = 4, bytes = 2 }\n";
  EXPECT_EQ(refusal(good + driver("d", inputs) + driver("e", replaced(inputs, "4", "5"))),
            "dir/plc.toml:16:10: driver d brings some of these inputs; move one of them");
  EXPECT_EQ(refusal(good + driver("d", inputs) + driver("e", replaced(inputs, "4", "6"))), "taken");
  EXPECT_NE(refusal(good + driver("d", "stale_bit = \"%QX0.0\"\n")).find("stale_bit must be an input"),
            std::string::npos);
  EXPECT_NE(refusal(good + driver("d", "stale_bit = \"%IX256.0\"\n")).find("stale_bit must be an input"),
            std::string::npos);
}

TEST(PlcConfiguration, a_program_that_sets_a_bit_of_a_word_of_another_cycle_is_refused_too) {
  const auto reader = [](const std::string& path) -> std::optional<std::string> {
    return path == "dir/b.il" ? "PROGRAM p\nVAR w AT %MX20.3 : BOOL; END_VAR\nLD TRUE\nS w\nEND_PROGRAM\n"
                              : program;
  };
  const auto parsed = parse_configuration(good + "sends = { first_word = 10, words = 1 }\n" + cycle_b,
                                          "dir/plc.toml", reader);
  ASSERT_FALSE(parsed);
  EXPECT_NE(parsed.error().find("dir/b.il:4:1: writes a word that cycle a sends"), std::string::npos);
}

TEST(PlcConfiguration, all_that_has_a_bound_is_refused_beyond_it) {
  const auto reader = [](const std::string&) -> std::optional<std::string> {
    return "PROGRAM p\nVAR i AT %IX256.0 : BOOL; q AT %QX0.0 : BOOL; END_VAR\nLD i\nST q\nEND_PROGRAM\n";
  };
  EXPECT_NE(parse_configuration(good, "dir/plc.toml", reader).error().find("uses addresses beyond %IB255"),
            std::string::npos);
  EXPECT_NE(refusal(good + std::string(configuration_bytes_max, '#')).find("longer than 1048576 bytes"),
            std::string::npos);
  std::string drivers;
  for (int i = 0; i < 17; ++i) drivers += driver(std::to_string(i), {});
  EXPECT_NE(refusal(good + drivers).find("more than 16 drivers"), std::string::npos);
  const auto signals = [](const std::string& table, int count) {
    std::string text = good + "[" + table + "]\nsignals = [";
    for (int i = 0; i < count; ++i) text += "\"%QX0.0\", ";
    return text + "]\n";
  };
  EXPECT_EQ(refusal(signals("archive", 256)), "taken");
  EXPECT_NE(refusal(signals("archive", 257)).find("more than 256 addresses"), std::string::npos);
  EXPECT_EQ(refusal(signals("realtime_data", 1024)), "taken");
  EXPECT_NE(refusal(signals("realtime_data", 1025)).find("more than 1024 addresses"), std::string::npos);
  EXPECT_EQ(refusal(good + "priority = 1\n"), "dir/plc.toml:7:12: priority must be an integer from 0 to 0");
}

TEST(PlcConfiguration, the_archive_lies_beside_the_file_or_where_its_whole_path_says) {
  const auto path = [](const std::string& given) {
    return parse_configuration(good + "[archive]\npath = \"" + given + "\"\n", "dir/plc.toml", read_source)
        .value()
        .archive.path;
  };
  EXPECT_EQ(path("history.sqlite"), "dir/history.sqlite");
  EXPECT_EQ(path("/var/history.sqlite"), "/var/history.sqlite");
}

TEST(PlcConfiguration, no_cut_of_a_good_file_does_harm) {
  for (std::size_t length = 0; length < good.size(); ++length)
    static_cast<void>(parse_configuration(good.substr(0, length), "dir/plc.toml", read_source));
}

TEST(PlcConfiguration, the_example_of_the_notes_is_good) {
  const auto text = read_file(EXAMPLE_CONFIGURATION);
  ASSERT_TRUE(text);
  const auto parsed = parse_configuration(*text, EXAMPLE_CONFIGURATION, read_file);
  ASSERT_TRUE(parsed) << parsed.error();
  EXPECT_EQ(parsed->cycles[1].name, "slow");
  EXPECT_EQ(parsed->drivers[0].config.stale_bit, 63U * 8);
}

struct Configured {
  SteadyPlcClock clock;
  ConfiguredPlc plc{"dir/plc.toml", read_source, [](const ConfiguredDriver&) { return nullptr; }, clock};
};

// I1
TEST(ConfiguredPlc, a_bad_configuration_changes_nothing_and_the_old_one_goes_on) {
  Configured rig;
  ASSERT_TRUE(rig.plc.reload(good));
  const auto before = rig.plc.plc();
  ASSERT_TRUE(before->order_run(StartKind::cold));
  EXPECT_FALSE(rig.plc.reload(good + "nonsense"));
  EXPECT_EQ(rig.plc.plc(), before);
  EXPECT_FALSE(before->is_stopped());
}

TEST(ConfiguredPlc, a_period_may_change_in_RUN_and_a_name_only_in_STOP) {
  Configured rig;
  ASSERT_TRUE(rig.plc.reload(good));
  const auto plc = rig.plc.plc();
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  EXPECT_TRUE(rig.plc.reload(replaced(good, "= 1", "= 2")));
  EXPECT_EQ(rig.plc.configuration().cycles[0].config.scan.period, 2ms);
  const std::string renamed = replaced(good, "\"a\"", "\"c\"");
  EXPECT_EQ(rig.plc.reload(renamed).error(),
            "dir/plc.toml: changes the name of cycle a, which cannot be done in RUN; order STOP, load it "
            "again, and "
            "order RUN");
  EXPECT_EQ(rig.plc.plc(), plc);
  plc->order_stop();
  while (!plc->is_stopped()) std::this_thread::yield();
  ASSERT_TRUE(rig.plc.reload(renamed));
  EXPECT_EQ(rig.plc.plc()->name(0), "c");
  EXPECT_EQ(plc->gateway().submit({.cycle = 0, .items = {{.section = {0, 1}, .written = {}}}}).error(),
            GatewayError::closed);
}

// I2: whatever the threads do, a RUN that was accepted is carried out by the PLC that is there afterwards.
TEST(ConfiguredPlc, a_RUN_that_comes_while_another_PLC_is_loaded_is_refused_or_prevents_it) {
  Configured rig;
  ASSERT_TRUE(rig.plc.reload(good));
  for (int i = 0; i < 30; ++i) {
    const auto old = rig.plc.plc();
    std::atomic<bool> accepted{false};
    std::thread orders{[&] { accepted = old->order_run(StartKind::cold); }};
    const std::string name = i % 2 == 0 ? "\"c\"" : "\"a\"";
    const bool loaded = rig.plc.reload(replaced(good, "\"a\"", name)).has_value();
    orders.join();
    ASSERT_NE(loaded, accepted) << "in turn " << i;
    ASSERT_EQ(loaded, rig.plc.plc() != old);
    if (!accepted) continue;
    old->order_stop();
    while (!old->is_stopped()) std::this_thread::yield();
    ASSERT_TRUE(rig.plc.reload(replaced(good, "\"a\"", name)));
  }
}

TEST(ConfiguredPlc, each_change_that_needs_STOP_is_named) {
  const auto change = [](const std::string& from, const std::string& to) {
    return change_that_needs_stop(parse_configuration(from, "dir/plc.toml", read_source).value(),
                                  parse_configuration(to, "dir/plc.toml", read_source).value());
  };
  EXPECT_EQ(change(good, replaced(good, "= 1", "= 2") + "watchdog_ms = 20\noverrun = \"stop\"\n"), "");
  EXPECT_EQ(change(good, replaced(good, "per-cycle", "one")), "threads or realtime");
  EXPECT_EQ(change(good, replaced(good, "[plc]\n", "[plc]\nrealtime = true\n")), "threads or realtime");
  const std::string slices = replaced(good, "[plc]\n", "[plc]\nslice_intervals_ms = [0, 5]\n");
  EXPECT_EQ(change(good, slices), "slice_intervals_ms");
  EXPECT_EQ(change(slices, slices + "priority = 1\n"), "the priority of cycle a");
  EXPECT_EQ(change(good, good + cycle_b), "the number of cycles");
  EXPECT_EQ(change(good, good + "sends = { first_word = 8, words = 1 }\n"), "what cycle a sends");
  EXPECT_EQ(change(good, replaced(good, "[plc]\n", "[plc]\noutputs_in_stop = \"hold\"\n")),
            "outputs_in_stop");
  EXPECT_EQ(change(good + driver("d", {}), good + driver("d", "late_ms = 7\n")), "the drivers");
  for (const char* const archive : {"path = \"a\"", "rows_max = 2000", "signals = [\"%QX0.0\"]"})
    EXPECT_EQ(change(good, good + "[archive]\n" + archive + "\n"), "the archive") << archive;
  EXPECT_EQ(change(good, good + "[realtime_data]\nsignals = [\"%QX0.0\"]\n"), "the real-time data");
  auto other = parse_configuration(good, "dir/plc.toml", read_source).value();
  other.cycles[0].source += ' ';
  EXPECT_EQ(change_that_needs_stop(parse_configuration(good, "dir/plc.toml", read_source).value(), other),
            "the program of cycle a");
}

TEST(ConfiguredPlc, each_setting_of_a_driver_is_one_of_them) {
  const auto with = [](const std::string& keys) {
    return parse_configuration(good + driver("d", keys), "dir/plc.toml", read_source).value();
  };
  const auto plain = with({});
  EXPECT_EQ(change_that_needs_stop(plain, plain), "");
  for (const char* const keys : {"late_ms = 7\n", "failures_max = 7\n", "on_stale = \"fault\"\n",
                                 "stale_bit = \"%IX9.0\"\n", "inputs = { first_byte = 0, bytes = 1 }\n"})
    EXPECT_EQ(change_that_needs_stop(plain, with(keys)), "the drivers") << keys;
  auto fixed = plain;
  fixed.drivers[0].fixed_inputs = {std::byte{1}};
  EXPECT_EQ(change_that_needs_stop(plain, fixed), "the drivers");
}

// I2: RUN comes while the drivers of the next PLC are made; in RUN none are made.
TEST(ConfiguredPlc, a_RUN_that_comes_in_the_middle_of_a_load_prevents_it) {
  class Silent final : public IoDriver {
    bool exchange(const OutputGate::Frame&, OutputGate&, std::span<std::byte>) noexcept override {
      return true;
    }
  };
  SteadyPlcClock clock;
  std::function<void()> during;
  int made_count = 0;
  ConfiguredPlc configured{"dir/plc.toml", read_source,
                           [&](const ConfiguredDriver&) {
                             ++made_count;
                             if (during) during();
                             return std::make_unique<Silent>();
                           },
                           clock};
  ASSERT_TRUE(configured.reload(good));
  const auto plc = configured.plc();
  during = [&] { ASSERT_TRUE(plc->order_run(StartKind::cold)); };
  const auto refused = configured.reload(good + driver("d", {}));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("changes the drivers, which cannot be done in RUN"), std::string::npos);
  EXPECT_EQ(configured.plc(), plc);
  EXPECT_FALSE(configured.reload(good + driver("d", {})));
  EXPECT_EQ(made_count, 1) << "a field has one driver at a time";
}

class CountingObserver final : public PlcObserver {
 public:
  CountingObserver(std::atomic<int>& alive, std::atomic<int>& steps) : alive_{alive}, steps_{steps} {
    ++alive_;
  }
  CountingObserver(const CountingObserver&) = delete;
  CountingObserver& operator=(const CountingObserver&) = delete;
  ~CountingObserver() override { --alive_; }
  void step_ordered(std::size_t, const ScanTask&, const CycleImage&,
                    std::chrono::nanoseconds) noexcept override {
    ++steps_;
  }
  void program_failed(std::size_t, SourcePlace) noexcept override {}
  void gateway_writes(std::size_t, const GatewayItem&) noexcept override {}

 private:
  std::atomic<int>& alive_;
  std::atomic<int>& steps_;
};

TEST(ConfiguredPlc, each_PLC_has_an_observer_of_its_own_that_lives_as_long_as_anybody_keeps_the_PLC) {
  SteadyPlcClock clock;
  std::atomic<int> alive{0};
  std::atomic<int> steps{0};
  {
    ConfiguredPlc configured{"dir/plc.toml", read_source, [](const ConfiguredDriver&) { return nullptr; },
                             clock,
                             [&](const PlcConfiguration&, std::chrono::nanoseconds) {
                               return std::make_unique<CountingObserver>(alive, steps);
                             }};
    ASSERT_TRUE(configured.reload(good));
    auto first = configured.plc();
    while (steps == 0) std::this_thread::yield();
    ASSERT_TRUE(configured.reload(replaced(good, "\"a\"", "\"c\"")));
    EXPECT_EQ(alive, 2);
    first.reset();
    EXPECT_EQ(alive, 1);
  }
  EXPECT_EQ(alive, 0);
}

TEST(ConfiguredPlc, an_archive_that_cannot_be_had_is_refused_with_its_place_and_changes_nothing) {
  SteadyPlcClock clock;
  ConfiguredPlc configured{
      "dir/plc.toml", read_source, [](const ConfiguredDriver&) { return nullptr; }, clock,
      [](const PlcConfiguration& asked,
         std::chrono::nanoseconds) -> tl::expected<std::unique_ptr<PlcObserver>, std::string> {
        if (asked.archive.path.empty()) return nullptr;
        return tl::unexpected{asked.archive.path + ": no such folder"};
      }};
  ASSERT_TRUE(configured.reload(good));
  const auto before = configured.plc();
  EXPECT_EQ(configured.reload(good + "[archive]\nrows_max = 1000\npath = \"/none/a\"\n").error(),
            "dir/plc.toml:9:8: /none/a: no such folder");
  EXPECT_EQ(configured.plc(), before);
  EXPECT_TRUE(before->order_run(StartKind::cold));
}

TEST(ConfiguredPlc, a_driver_of_an_unknown_kind_is_refused) {
  Configured rig;
  EXPECT_NE(rig.plc.reload(good + "[[driver]]\nname = \"d\"\nkind = \"x\"\nperiod_ms = 1\n")
                .error()
                .find("no kind \"x\""),
            std::string::npos);
}

}  // namespace
}  // namespace emulator_models::soft_plc
