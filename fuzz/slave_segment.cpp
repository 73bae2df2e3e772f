// The emulator against whatever a segment holds: the slave, the handler's loop and an FX PLC, woken once.
//
//   byte   0          options: the segment's, by bit: K2 halves, K3 reset, K6 bytes first, K9 load once
//   from   1          the segment's bytes from its beginning; what is missing is 0, what is too much is not looked at
//
// What it does with an FX frame is judged elsewhere. Here: a request that reaches the PLC has the bytes that stand in the
// segment, and not more than may come there; the answer that is put there has not more bytes than its area; what is not the
// slave's to write is as before, and nothing is written behind the end.

#include <fcntl.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/fx_plc_emulator.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using protocol::PaperOptions;

PaperOptions options_of(unsigned bits) {
  PaperOptions options;
  if ((bits & 1U) != 0) options.state_coding = PaperOptions::StateCoding::halves;
  if ((bits & 2U) != 0) options.semaphore_after_answer = PaperOptions::SemaphoreAfterAnswer::reset;
  if ((bits & 4U) != 0) options.area_order = PaperOptions::AreaOrder::bytes_first;
  if ((bits & 8U) != 0) options.length_check = PaperOptions::LengthCheck::load_once;
  return options;
}

/// The named objects, as somebody else has made them, one page longer than the slave needs; their names go away with it.
class PreparedSegment {
 public:
  PreparedSegment(std::string name, std::size_t bytes) : name_{std::move(name)}, bytes_{bytes} {
    remove();
    const int descriptor = shm_open(name_.c_str(), O_CREAT | O_EXCL | O_RDWR, 0600);
    ltsim::expect(descriptor >= 0 && ftruncate(descriptor, static_cast<off_t>(bytes_)) == 0,
                  "a segment can be made");
    memory_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    close(descriptor);
    sem_t* const semaphore = sem_open(name_.c_str(), O_CREAT | O_EXCL, 0600, 1);
    ltsim::expect(memory_ != MAP_FAILED && semaphore != SEM_FAILED, "a segment can be made");
    sem_close(semaphore);
  }
  ~PreparedSegment() {
    munmap(memory_, bytes_);
    remove();
  }
  PreparedSegment(const PreparedSegment&) = delete;
  PreparedSegment& operator=(const PreparedSegment&) = delete;

  void remove() const noexcept {
    shm_unlink(name_.c_str());
    sem_unlink(name_.c_str());
  }
  [[nodiscard]] std::span<std::byte> bytes() const noexcept {
    return {static_cast<std::byte*>(memory_), bytes_};
  }

 private:
  std::string name_;
  std::size_t bytes_;
  void* memory_;
};

/// Compares what is taken and put back with the segment, and stops the slave behind the answer.
class Judge final : public protocol::ExchangeObserver {
 public:
  Judge(const protocol::SegmentLayout& layout, const PaperOptions& options, std::vector<std::byte> before)
      : layout_{layout}, options_{options}, before_{std::move(before)} {}

  void stops(emulator_models::EmulatorHandler& handler) { handler_ = &handler; }

  void executed(std::span<const std::byte> request) noexcept override {
    const bool checked = options_.length_check != PaperOptions::LengthCheck::none;
    const std::size_t bytes_max =
        checked ? layout_.request.capacity_bytes : layout_.size_bytes - layout_.request.bytes_offset;
    std::uint32_t length = 0;
    std::memcpy(&length, before_.data() + layout_.request.length_offset, sizeof length);
    const std::size_t expected = length <= bytes_max ? length : checked ? 0 : bytes_max;
    holds_ = request.size() == expected &&
             std::ranges::equal(request, std::span{before_}.subspan(layout_.request.bytes_offset, expected));
  }
  void announced() noexcept override { handler_->request_stop(); }

  void check(std::span<const std::byte> after) const {
    ltsim::expect(holds_, "the PLC gets the bytes of the segment, as many as may be");
    const auto is_as_before = [&](std::size_t begin, std::size_t end) {
      return std::ranges::equal(after.subspan(begin, end - begin),
                                std::span{before_}.subspan(begin, end - begin));
    };
    ltsim::expect(is_as_before(layout_.request.length_offset, layout_.response.length_offset),
                  "the slave leaves the request as it is");
    std::uint32_t length = 0;
    std::memcpy(&length, after.data() + layout_.response.length_offset, sizeof length);
    ltsim::expect(length <= layout_.response.capacity_bytes, "the answer fits its area");
    ltsim::expect(is_as_before(layout_.response.bytes_offset + length, after.size()),
                  "nothing is written behind the answer");
  }

 private:
  protocol::SegmentLayout layout_;
  PaperOptions options_;
  std::vector<std::byte> before_;
  emulator_models::EmulatorHandler* handler_ = nullptr;
  bool holds_ = false;
};

}  // namespace

FUZZ_TARGET("slave-segment", {}, "the emulator, woken once, against whatever a segment holds") {
  constexpr std::size_t guard_bytes = 4096;
  const PaperOptions options = options_of(input.empty() ? 0 : std::to_integer<unsigned>(input.front()));
  const protocol::SegmentLayout layout = protocol::segment_layout(options);
  const std::string name = "fuzz-slave-segment-" + std::to_string(getpid());
  const PreparedSegment segment{name, layout.size_bytes + guard_bytes};
  const auto content = input.subspan(std::min<std::size_t>(input.size(), 1));
  std::ranges::fill(segment.bytes().subspan(layout.size_bytes), std::byte{0xa5});
  std::ranges::copy(content.first(std::min(content.size(), layout.size_bytes)), segment.bytes().begin());

  Judge judge{layout, options, {segment.bytes().begin(), segment.bytes().end()}};
  emulator_models::FxPlcEmulator plc{protocol::fx::Model::fx2n};
  protocol::SlaveSharedMemoryWrapper slave{name, options, &judge};
  emulator_models::EmulatorHandler handler{slave, plc};
  judge.stops(handler);
  ltsim::expect(slave.open().has_value(), "the slave opens what is there");
  segment.remove();  // a run that ends here leaves nothing behind
  handler.run();
  judge.check(segment.bytes());
}
