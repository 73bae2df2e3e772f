// One cycle of a soft PLC: the steps of a scan, carried out on the body's image and on what the cycles share.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "emulator_models/soft_plc/cycle_body.hpp"
#include "emulator_models/soft_plc/gateway.hpp"
#include "emulator_models/soft_plc/io_manager.hpp"
#include "emulator_models/soft_plc/output_gate.hpp"
#include "emulator_models/soft_plc/plc_observer.hpp"
#include "emulator_models/soft_plc/scan_program.hpp"
#include "emulator_models/soft_plc/variable_exchange.hpp"

namespace emulator_models::soft_plc {

/// A lamp that is on while at least one cycle wants it; at most 32 cycles.
class AlarmLamp {
 public:
  void set(std::size_t cycle, bool on) noexcept {
    const std::uint32_t bit = std::uint32_t{1} << cycle;
    if (on) {
      wanted_.fetch_or(bit);
    } else {
      wanted_.fetch_and(~bit);
    }
  }
  [[nodiscard]] bool is_on() const noexcept { return wanted_.load() != 0; }

 private:
  std::atomic<std::uint32_t> wanted_{0};
};

/// What all cycles of a PLC share.
struct PlcParts {
  VariableExchange exchange;
  IoManager io;
  OutputGate gate;
  AlarmLamp lamp;
  PlcObserver* observer = nullptr;  ///< may be null
};

class PlcCycle final : public ScanProgram {
 public:
  PlcCycle(std::size_t index, std::unique_ptr<CycleBody> body, PlcParts& parts, Gateway& gateway) noexcept
      : index_{index}, body_{std::move(body)}, image_{body_->image()}, parts_{parts}, gateway_{gateway} {}

  /// The run that the following scans belong to.
  void begin_run(std::uint64_t run) noexcept { run_ = run; }

  [[nodiscard]] const CycleImage& image() const noexcept { return image_; }

  void system_analysis() noexcept override { gateway_.serve(index_, image_, parts_.observer); }
  void initialise(StartKind start) noexcept override {
    body_->start(start);
    if (start == StartKind::cold) parts_.exchange.send(index_, image_.memory);
  }
  void read_inputs() noexcept override { parts_.io.latch(image_.inputs); }
  void read_from_cycles() noexcept override { parts_.exchange.receive(index_, image_.memory); }
  Progress execute(const ScanStep& step) noexcept override {
#ifdef LTSIM_MUTANT_GATEWAY_BETWEEN_SLICES  // a request need not wait for the end of the scan
    gateway_.serve(index_, image_, parts_.observer);
#endif
    const Progress progress = body_->execute(step);
    if (progress == Progress::failed && parts_.observer != nullptr) {
      if (const auto place = body_->failed_at()) parts_.observer->program_failed(index_, *place);
    }
    return progress;
  }
  void write_to_cycles() noexcept override { parts_.exchange.send(index_, image_.memory); }
  /// The body's image is the output image.
  void refresh_output_image() noexcept override {}
  void write_outputs() noexcept override {
    static_cast<void>(parts_.gate.commit(run_, body_->output_mask(), image_.outputs));
  }
  void write_safe_outputs() noexcept override {
    static_cast<void>(parts_.gate.close(run_));
    body_->give_up_scan();
  }
  void set_alarm_lamp(bool on) noexcept override { parts_.lamp.set(index_, on); }

 private:
  const std::size_t index_;
  const std::unique_ptr<CycleBody> body_;
  const CycleImage image_;
  PlcParts& parts_;
  Gateway& gateway_;
  std::uint64_t run_ = 0;
};

}  // namespace emulator_models::soft_plc
