// The configuration of a soft PLC: whatever the text, it is refused as a whole with file, line, column and reason, or it is
// within its bounds, a PLC can be built of it, or is refused with a reason, and that PLC runs.
//
// The programs that it names lie in a folder of this target's own: good.il, other.il, bad.il, beyond.il.

#include <charconv>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "emulator_models/soft_plc/configured_plc.hpp"
#include "emulator_models/soft_plc/il_cycle.hpp"
#include "emulator_models/soft_plc/plc_configuration.hpp"
#include "emulator_models/soft_plc/soft_plc.hpp"
#include "fuzz/text_input.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using namespace emulator_models::soft_plc;
using namespace std::chrono_literals;
using ltsim::expect;

const std::string file_name = "folder/plc.toml";

std::optional<std::string> read_program(const std::string& path) {
  static const std::map<std::string, std::string> files{
      {"folder/good.il",
       "PROGRAM p\nVAR w AT %MW8 : INT; END_VAR\nLD w\nADD 1\nST w\nLD %IX0.0\nST %QX0.0\nEND_PROGRAM\n"},
      {"folder/other.il", "PROGRAM p\nLD %IX0.0\nANDN %MX0.0\nST %QX1.0\nLD %MW8\nST %QW1\nEND_PROGRAM\n"},
      {"folder/bad.il", "PROGRAM p\nADD 1\nEND_PROGRAM\n"},
      {"folder/beyond.il", "PROGRAM p\nLD %IX300.0\nST %QX0.0\nEND_PROGRAM\n"}};
  const auto found = files.find(path);
  return found == files.end() ? std::nullopt : std::optional{found->second};
}

/// Takes a number and a colon off the front.
std::optional<std::size_t> take_number(std::string_view& text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end == text.data() + text.size() || *end != ':') return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  return number;
}

void check_refusal(std::string_view text, std::string_view refusal) {
  expect(refusal.starts_with(file_name + ":"), "a refusal names the file");
  refusal.remove_prefix(file_name.size() + 1);
  const auto line = take_number(refusal);
  const auto column = take_number(refusal);
  expect(line && column, "a refusal names a line and a column");
  expect(fuzz::is_inside(text, *line, *column), "a refusal names a place of the text");
  expect(refusal.size() > 1, "a refusal has a reason");
}

void check_bounds(const PlcConfiguration& configuration) {
  expect(!configuration.cycles.empty() && configuration.cycles.size() <= cycles_max,
         "a PLC has 1 to 32 cycles");
  expect(!configuration.slice_intervals.empty(), "there is a priority");
  for (const ConfiguredCycle& cycle : configuration.cycles) {
    const ScanConfig& scan = cycle.config.scan;
    expect(!cycle.name.empty(), "a cycle has a name");
    expect(scan.period >= 0ns && scan.period <= 1h, "a period is between 0 and an hour");
    expect(scan.watchdog_limit > 0ns && scan.watchdog_limit <= 1h, "a watchdog has a limit");
    expect(cycle.config.priority < configuration.slice_intervals.size(), "a priority has an interval");
    expect(cycle.sends.fits(memory_bytes_max), "a cycle sends words that there are");
  }
  for (const ConfiguredDriver& driver : configuration.drivers) {
    expect(driver.config.period > 0ns && driver.config.late_after > 0ns, "a driver has a period");
    expect(driver.config.inputs.fits(inputs_bytes_max), "a driver brings inputs that there are");
    expect(driver.fixed_inputs.size() <= driver.config.inputs.bytes, "inputs that are fixed have a place");
  }
  expect(configuration.gateway.queue_max >= 1 && configuration.gateway.requests_per_scan_max >= 1 &&
             configuration.answer_timeout > 0ms,
         "the gateway answers");
  expect(change_that_needs_stop(configuration, configuration).empty(), "what is equal is no change");
}

class NoField final : public IoDriver {
 public:
  bool exchange(const OutputGate::Frame&, OutputGate&, std::span<std::byte>) noexcept override {
    return false;
  }
};

void build_and_run(const PlcConfiguration& configuration) {
  SoftPlcSetup setup;
  setup.slice_intervals = configuration.slice_intervals;
  setup.gateway = configuration.gateway;
  for (const ConfiguredCycle& cycle : configuration.cycles)
    setup.cycles.push_back({cycle.name, cycle.config, cycle.sends, std::make_unique<IlCycle>(cycle.program)});
  for (const ConfiguredDriver& driver : configuration.drivers)
    setup.drivers.push_back({driver.config, std::make_unique<NoField>()});
  auto plc = SoftPlc::make(std::move(setup), 0ns);
  if (!plc) {
    expect(!plc.error().empty(), "a PLC that cannot be built has a reason");
    return;
  }
  expect((*plc)->order_run(StartKind::cold), "a new PLC takes RUN");
  auto now = 0ns;
  constexpr int slices = 8;
  for (int i = 0; i < slices; ++i) {
    const auto next = (*plc)->advance(now);
    now = std::max(now + 1us, std::min(next, now + 1h));
  }
  (*plc)->stop_now();
}

}  // namespace

FUZZ_TARGET("plc-config", {},
            "the configuration of a soft PLC: refused as a whole, or a PLC is built and runs") {
  const std::string_view text = fuzz::text_of(input);
  const auto configuration = parse_configuration(text, file_name, read_program);
  if (!configuration) {
    check_refusal(text, configuration.error());
    return;
  }
  check_bounds(*configuration);
  build_and_run(*configuration);
}
