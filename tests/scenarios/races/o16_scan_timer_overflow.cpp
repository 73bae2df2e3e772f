// An on-delay timer whose elapsed time is a TIME of 32 bits: after 24.8 days it turns negative, and the output drops
// though the input stayed on (LoRaMac-node #218, FAA AD 2015-09-07, plcLib PR #4).

#include <algorithm>
#include <limits>
#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Image {
  std::atomic<std::uint32_t> input;
};

/// Retentive on-delay timer: goes on from the time it had when the machine was switched off.
class OnDelayTimer {
 public:
  OnDelayTimer(std::int32_t preset_ms, std::int32_t retained_ms, bool saturates)
      : preset_ms_(preset_ms), elapsed_ms_(retained_ms), saturates_(saturates) {}

  /// One scan. @return the output
  bool scan(bool input, std::int32_t scan_ms) {
    if (!input) elapsed_ms_ = 0;
    if (input) elapsed_ms_ = saturates_ ? std::min(elapsed_ms_, preset_ms_) + scan_ms : wrapping(scan_ms);
    return elapsed_ms_ >= preset_ms_;
  }

 private:
  /// As the PLC's adder does it.
  [[nodiscard]] std::int32_t wrapping(std::int32_t scan_ms) const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(elapsed_ms_) +
                                     static_cast<std::uint32_t>(scan_ms));
  }

  std::int32_t preset_ms_;
  std::int32_t elapsed_ms_;
  bool saturates_;
};

}  // namespace

SHAPE("races/o16-scan-timer-overflow",
      {.finding = "timer", .depth = 1, .tasks_count = 2, .cure = "the elapsed time stops at the preset time"},
      "an elapsed time of 32 bits turns negative") {
  races::name_words(world, "image", {"input"});

  world.process("plc").start("inputs", [] {
    const races::Shared<Image> image{"image"};
    image->input = 1;
  });
  world.process("plc").start("scan", [&] {
    const races::Shared<Image> image{"image"};
    OnDelayTimer timer{1000, std::numeric_limits<std::int32_t>::max() - 50, corrected};
    bool was_on = false;
    for (int scan = 0; scan < 10; ++scan) {
      const bool input = image->input != 0;
      const bool on = timer.scan(input, 10);
      world.require(on || !was_on || !input, "timer: its output drops though its input stayed on");
      was_on = on;
      std::this_thread::sleep_for(races::Milliseconds{10});
    }
  });
  world.run();
}
