// The FX PLC as a session: one line a request, or an event in words.
//
//   FX1S, FX1N, FX2N, FX3U   switched off, and on again as this model; at first an FX3U
//   scan, scan N             the next scan, N ms later than it is due (N up to 9999)
//   run, stop                the RUN switch
//   in N                     the terminal of the input of index N toggles
//   anything else            a message at the programming port, without the '\n'
//
// Each answer, each scan's outputs and at the end the number of ones in the memory are those of the reference PLC. Until
// the first scan nothing but the port has touched the memory.

#include <algorithm>
#include <bit>
#include <charconv>
#include <chrono>
#include <optional>
#include <string>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/fx_plc.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "fuzz/fx_frame_mutator.hpp"
#include "fuzz/fx_reference_plc.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using emulator_models::FxPlc;
using emulator_models::FxPlcEmulator;
using emulator_models::SteadyTime;
using emulator_models::Terminals;
using fuzz::ReferencePlc;
using protocol::fx::Model;
using std::chrono::milliseconds;

constexpr std::string_view program_source = "PROGRAM session\nLD X0\nST Y0\nLD D0\nST D1\nEND_PROGRAM\n";
/// 2025-08-08, 16:31:49.
constexpr emulator_models::WallTime wall{std::chrono::seconds{1'754'670'709}};

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// One PLC from switching on to switching off, and its reference.
class PlcPair {
 public:
  explicit PlcPair(Model model) : model_{model}, emulator_{model}, reference_{model} {}
  PlcPair(const PlcPair&) = delete;
  PlcPair& operator=(const PlcPair&) = delete;

  void send(std::string_view message) {
    const auto answer = emulator_.process(std::as_bytes(std::span{message}));
    ltsim::expect(text_of(protocol::fx::as_span(answer)) == reference_.answer(message),
                  "a PLC answers as its tables say");
  }

  void set_run_switch(bool on) {
    scanned().set_run_switch(on);
    reference_.set_run_switch(on);
  }

  void toggle_input(unsigned index) {
    inputs_.flip(index % inputs_.size());
    reference_.toggle_input(index % static_cast<unsigned>(inputs_.size()));
  }

  void scan(milliseconds late) {
    FxPlc& plc = scanned();
    now_ += late;
    reference_.scan(std::chrono::duration_cast<milliseconds>(now_.time_since_epoch()), late);
    for (;;) {
      const auto step = plc.advance(now_, wall);
      if (step.action != emulator_models::soft_plc::ScanAction::wait) continue;
      now_ = std::max(now_, SteadyTime{step.until});
      break;
    }
    const auto outputs = std::bit_cast<ReferencePlc::Points>(plc.terminals().outputs);
    ltsim::expect(outputs == reference_.terminal_outputs(),
                  "a scan drives the outputs that its program sets");
  }

  /// The whole memory holds as many ones as that of the reference.
  void compare_memories() {
    ltsim::expect(fuzz::ones_in(emulator_.lock()->bytes()) == reference_.ones_count(),
                  "a PLC changes what its tables say, and nothing else");
  }

 private:
  FxPlc& scanned() {
    if (!plc_) {
      program_.emplace(
          emulator_models::soft_plc::compile(program_source, emulator_models::FxAddressMap{model_}).value());
      const auto wires = [this](Terminals& terminals, SteadyTime) { terminals.inputs = inputs_; };
      plc_.emplace(emulator_, *program_, wires, nullptr, emulator_models::FxPlcConfig{}, now_);
    }
    return *plc_;
  }

  Model model_;
  FxPlcEmulator emulator_;
  ReferencePlc reference_;
  emulator_models::TerminalPoints inputs_;
  SteadyTime now_{std::chrono::hours{1}};
  std::optional<emulator_models::soft_plc::IlProgram> program_;
  std::optional<FxPlc> plc_;
};

/// "scan 250" after "scan " -> 250. @return nothing unless all of it is a number of up to four digits
std::optional<unsigned> number_behind(std::string_view word, std::string_view line) {
  if (!line.starts_with(word)) return std::nullopt;
  line.remove_prefix(word.size());
  unsigned number = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
  if (line.empty() || line.size() > 4 || error != std::errc{} || end != line.data() + line.size())
    return std::nullopt;
  return number;
}

class Session {
 public:
  Session() { plcs_.emplace(Model::fx3u); }

  void play(std::string_view line) {
    if (const auto model = line.starts_with("FX") ? protocol::fx::parse_model(line) : std::nullopt) {
      finish();
      plcs_.emplace(*model);
    } else if (line == "run" || line == "stop") {
      plcs_->set_run_switch(line == "run");
    } else if (line == "scan") {
      plcs_->scan(milliseconds{0});
    } else if (const auto late = number_behind("scan ", line)) {
      plcs_->scan(milliseconds{*late});
    } else if (const auto index = number_behind("in ", line)) {
      plcs_->toggle_input(*index);
    } else {
      plcs_->send(line);
    }
  }

  void finish() { plcs_->compare_memories(); }

 private:
  std::optional<PlcPair> plcs_;
};

std::size_t mutate(std::span<std::byte> data, std::size_t size, unsigned seed, ltsim::PlainMutator plain) {
  static constexpr std::string_view events[] = {"scan", "scan",   "run",      "stop",     "FX1S",
                                                "FX1N", "FX2N",   "FX3U",     "in 0",     "in 9",
                                                "\x05", "scan 5", "scan 200", "scan 201", "scan 1"};
  return fuzz::mutate_lines(data, size, seed, plain, events);
}

}  // namespace

FUZZ_TARGET("fx-session", {.split = ltsim::lines_as_records, .mutate = mutate},
            "requests, scans and the RUN switch of an FX PLC, against a second, simple one") {
  Session session;
  for (std::string_view line : ltsim::lines_as_records(text_of(input))) {
    if (line.ends_with('\n')) line.remove_suffix(1);
    session.play(line);
  }
  session.finish();
}
