// From the scans of an FxPlc to rows that an engineer reads, on the archive's thread and without any.
#include "emulator_models/archive/plc_archive.hpp"

#include "emulator_models/archive/fx_archive.hpp"
#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/fx_plc.hpp"
#include "emulator_models/fx_recorder.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "tests/emulator_models/archive/archive_rig.hpp"

namespace emulator_models::archive {
namespace {

using namespace std::chrono_literals;
using protocol::fx::Model;

class PlcArchiveTest : public ArchiveTest {
 protected:
  PlcArchiveTest() {
    plc.observe_with(&recorder);
    config.signal_names = {"motor"};
  }
  void scan_until(SteadyTime end) {
    while (now < end) {
      const auto step = plc.advance(now, {});
      if (step.action == soft_plc::ScanAction::wait) now = std::max(now, SteadyTime{step.until});
    }
  }

  static constexpr protocol::fx::Device y0{protocol::fx::DeviceKind::y, 0};
  SteadyTime now{1h};
  FxPlcEmulator emulator{Model::fx3u};
  soft_plc::IlProgram program =
      soft_plc::compile("PROGRAM blink VAR y AT Y0 : BOOL; END_VAR\nLDN y\nST y\nEND_PROGRAM\n",
                        FxAddressMap{Model::fx3u})
          .value();
  FxPlc plc{emulator, program, {}, nullptr, {}, now};
  FxRecorder recorder{{.signals = {y0}}, Model::fx3u, now};
};

TEST_F(PlcArchiveTest, what_the_plc_did_stands_in_the_file_after_stop) {
  auto archive = PlcArchive::open(config, {&recorder.ring()}, {});
  ASSERT_TRUE(archive) << archive.error().message;
  scan_until(now + 2s);
  recorder.finish(now);
  (*archive)->stop();
  EXPECT_EQ((*archive)->lost_count(), 0U);
  EXPECT_EQ(query("SELECT sum(scans_count) FROM scans"), "200 ");
  EXPECT_EQ(query("SELECT event, what FROM history ORDER BY id LIMIT 2"), "mode RUN signal motor: 1 -> 0 ");
  EXPECT_EQ((*archive)->counts().stored_count, 1U + 199U + 2U);
}

TEST_F(PlcArchiveTest, a_simulated_day_stores_its_seconds_without_a_thread) {
  ArchiveDrain drain{std::move(ArchiveDatabase::open(config).value()), {&recorder.ring()}, {}};
  const SteadyTime power_up = now;
  for (std::uint64_t second = 1; second <= 60; ++second) {
    scan_until(power_up + std::chrono::seconds{second});
    drain.drain();
    ASSERT_EQ(query("SELECT count(*) FROM signal_changes"), std::to_string(second * 100 - 1) + " ");
  }
  recorder.finish(now);
  drain.finish();
  EXPECT_EQ(drain.counts().lost_count + recorder.ring().lost_count(), 0U);
  EXPECT_EQ(query("SELECT sum(scans_count), max(last_scan) FROM scans"), "6000 6000 ");
}

TEST_F(PlcArchiveTest, a_file_that_cannot_be_had_is_told_and_nothing_runs) {
  config.file = folder.path() / "missing" / "plc.archive";
  const auto archive = PlcArchive::open(config, {&recorder.ring()}, {});
  ASSERT_FALSE(archive);
  EXPECT_EQ(archive.error().code, ArchiveErrorCode::cannot_open);
}

TEST_F(PlcArchiveTest, what_is_lost_in_ring_and_file_is_one_sum) {
  auto archive = PlcArchive::open(config, {&recorder.ring()}, {});
  ASSERT_TRUE(archive);
  (*archive)->stop();
  scan_until(now + 100ms);
  EXPECT_EQ((*archive)->lost_count(), 1U + 9U);
}

TEST_F(PlcArchiveTest, the_archive_that_options_ask_for_names_its_signals_and_its_wall_clock) {
  const auto archive = FxArchive::open({.path = config.file, .signals = {"y0", "M8000"}}, Model::fx3u, now,
                                       WallTime{24h * 365}, {});
  ASSERT_TRUE(archive) << archive.error();
  plc.observe_with(&(*archive)->recorder());
  scan_until(now + 1s);
  EXPECT_EQ((*archive)->stop(now), "archive: 101 rows stored, 0 records lost");
  EXPECT_EQ(query("SELECT DISTINCT signal, wall_clock < '1971-01-01 00:00:01' FROM signal_changes"), "Y0 1 ");
  EXPECT_EQ(query("SELECT min(wall_clock) FROM signal_changes"), "1971-01-01 00:00:00.010 ");
}

TEST_F(PlcArchiveTest, signals_that_are_none_are_refused_with_their_name) {
  const std::vector<std::string> names[] = {
      {"Y0", "X9"}, {"D100"}, {"nonsense"}, std::vector<std::string>(257, "M0")};
  for (const auto& signals : names) {
    const auto archive = FxArchive::open({.path = config.file, .signals = signals}, Model::fx3u, now, {}, {});
    ASSERT_FALSE(archive);
    EXPECT_NE(archive.error().find(signals.size() > 256 ? "257" : signals.back()), std::string::npos)
        << archive.error();
  }
  EXPECT_FALSE(std::filesystem::exists(config.file));
}

}  // namespace
}  // namespace emulator_models::archive
