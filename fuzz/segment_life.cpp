// Both sides open, close and remove the handoff's objects in any order, where somebody may have left objects of those names:
// a segment of another size, a semaphore with posts, or one of the two alone.
//
// A few lines say again what the named objects are in; each step is compared with them.

#include <array>
#include <chrono>
#include <optional>
#include <utility>

#include "fuzz/hostile_peer.hpp"
#include "protocol/master_shared_memory_wrapper.hpp"
#include "protocol/shared_memory_port.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "sim_clock/scenario/fuzz_scenario.hpp"

namespace {

using namespace std::chrono_literals;
using protocol::PaperOptions;
using protocol::PortError;
using protocol::SharedMemoryError;

PaperOptions choose_options(ltsim::World& world) {
  PaperOptions options = fuzz::small_areas();
  options.initialiser = static_cast<PaperOptions::Initialiser>(world.choose("who fills with zeros", 4));
  options.semaphore_start = static_cast<PaperOptions::SemaphoreStart>(world.choose("count at the start", 3));
  if (world.choose("maximum", 2) == 1) options.semaphore_maximum = PaperOptions::SemaphoreMaximum::one;
  if (world.choose("time-out", 2) == 1) options.on_time_out = PaperOptions::OnTimeOut::send_again;
  options.read_timeout = 5ms;
  return options;
}

/// What the system has under the name.
struct Named {
  std::optional<std::size_t> segment_bytes;
  bool semaphore = false;
  [[nodiscard]] bool any() const noexcept { return segment_bytes.has_value() || semaphore; }
};

Named leave_objects(ltsim::World& world, std::size_t needed_bytes) {
  constexpr std::array<std::byte, 64> zeros{};
  Named named;
  if (const std::size_t left = world.choose("segment left", needed_bytes + 3); left > 0) {
    named.segment_bytes = left - 1;
    world.leave_segment(fuzz::segment, std::span{zeros}.first(*named.segment_bytes));
  }
  if (const std::size_t left = world.choose("semaphore left", 4); left > 0) {
    named.semaphore = true;
    world.leave_semaphore(fuzz::segment, static_cast<unsigned>(left - 1));
  }
  return named;
}

class TwoSides {
 public:
  TwoSides(ltsim::World& world, const PaperOptions& options, const Named& named)
      : world_{world},
        needed_bytes_{protocol::segment_layout(options).size_bytes},
        posts_are_limited_{options.semaphore_maximum == PaperOptions::SemaphoreMaximum::one},
        named_{named},
        port_{fuzz::segment, options},
        master_{fuzz::segment, options},
        slave_{fuzz::segment, options} {}

  void open_port() {
    const bool was_open = port_.is_open();
    const bool fits = was_open || open_has_room();
    const auto opened = port_.open();
    expect_open(opened.has_value(), fits, port_.is_open());
    if (!opened) {
      world_.require(opened.error() == PortError::cannot_open, "a segment that is too small is refused");
      world_.require(!to_string(opened.error()).empty(), "a refusal has words");
    }
  }

  void open_slave() {
    const bool was_open = slave_.is_open();
    const bool is_new = !was_open && named_.segment_bytes.value_or(0) == 0;
    const bool fits = was_open || open_has_room();
    const auto opened = slave_.open();
    expect_open(opened.has_value(), fits, slave_.is_open());
    world_.require(was_open || slave_.created_segment() == is_new, "who gives a segment its size knows");
    if (!opened) {
      world_.require(opened.error() == SharedMemoryError::segment_too_small,
                     "the refusal says what is wrong");
      world_.require(!to_string(opened.error()).empty(), "a refusal has words");
    }
  }

  void close_port() {
    port_.close();
    world_.require(!port_.is_open(), "what was closed is not open");
  }

  void close_slave() {
    slave_.close();
    world_.require(!slave_.is_open(), "what was closed is not open");
  }

  void exchange() {
    constexpr std::array<std::byte, 10> request{};  // there is room for 8
    std::array<std::byte, 8> answer{};
    const auto sent = std::span{request}.first(world_.choose("request", request.size() + 1));
    const auto written = port_.write(sent);
    const bool has_room = sent.size() <= answer.size();
    world_.require(written.has_value() || !port_.is_open() || !has_room || posts_are_limited_,
                   "an open port takes what fits");
    world_.require(written.has_value() || !to_string(written.error()).empty(), "a refusal has words");
    const auto read = port_.read(answer);
    world_.require(read.has_value() == port_.is_open(), "an open port can be read");
    if (!port_.is_open()) {
      world_.require(written == tl::unexpected{PortError::not_open} && read == written,
                     "a closed port says that it is");
    }
  }

  void exchange_without_port() {
    const bool opens = world_.choose("opens before", 2) == 1;
    if (opens) {
      const bool fits = open_has_room();
      const auto opened = master_.open();
      expect_open(opened.has_value(), fits, master_.is_open());
    }
    constexpr std::array<std::byte, 10> request{};  // there is room for 8
    const auto sent = std::span{request}.first(world_.choose("request", request.size() + 1));
    const auto written = master_.write(sent);
    if (!written) {
      const bool expected = written.error() == SharedMemoryError::not_open           ? !master_.is_open()
                            : written.error() == SharedMemoryError::request_too_long ? sent.size() > 8
                                                                                     : posts_are_limited_;
      world_.require(expected, "a request is refused for a reason that there is");
      world_.require(!to_string(written.error()).empty(), "a refusal has words");
    }
    std::array<std::byte, 8> answer{};
    world_.require(master_.get_response(answer).has_value() == master_.is_open(),
                   "what is open can be read, and nothing else");
    master_.close();
  }

  /// A name that the system cannot take.
  void open_impossible() {
    protocol::SlaveSharedMemoryWrapper slave{"no/folders", slave_.options()};
    const auto opened = slave.open();
    world_.require(opened == tl::unexpected{SharedMemoryError::cannot_open} && !slave.is_open(),
                   "what the system refuses cannot be opened");
    world_.require(!to_string(opened.error()).empty(), "a refusal has words");
  }

  void set_timeouts() {
    const std::chrono::milliseconds timeout{1 + world_.choose("milliseconds", 8)};
    port_.set_timeouts({.read = timeout});
    port_.purge();
  }

  void remove() {
    const bool was_any = std::exchange(named_, {}).any();
    world_.require(protocol::SharedMemoryWrapper::remove(slave_.segment_name()) == was_any,
                   "removing says whether there was anything");
  }

  void look() const {
    world_.require(protocol::SharedMemoryWrapper::exists(fuzz::segment) == named_.any(),
                   "the name is there from the first opening until it is removed");
  }

 private:
  /// Whether the one that opens now finds room; afterwards the objects are there in any case.
  bool open_has_room() {
    named_.semaphore = true;
    if (named_.segment_bytes.value_or(0) == 0) named_.segment_bytes = needed_bytes_;
    return *named_.segment_bytes >= needed_bytes_;
  }

  void expect_open(bool opened, bool fits, bool is_open) const {
    world_.require(opened == fits, "a segment opens unless one is there that is too small");
    world_.require(is_open == fits, "what was opened is open");
  }

  ltsim::World& world_;
  std::size_t needed_bytes_;
  bool posts_are_limited_;
  Named named_;
  protocol::SharedMemoryPort port_;
  protocol::MasterSharedMemoryWrapper master_;  // what is in a port, used without one
  protocol::SlaveSharedMemoryWrapper slave_;
};

}  // namespace

FUZZ_SCENARIO("segment-life",
              "both sides open, close and remove the segment, whatever was left under its name") {
  constexpr std::size_t steps_max = 12;
  const PaperOptions options = choose_options(world);
  const Named named = leave_objects(world, protocol::segment_layout(options).size_bytes);
  const std::size_t steps = 1 + world.choose("steps", steps_max);
  world.process("kernel").start("main", [&] {
    TwoSides sides{world, options, named};
    static constexpr std::array actions{&TwoSides::open_port,      &TwoSides::exchange,
                                        &TwoSides::close_port,     &TwoSides::open_slave,
                                        &TwoSides::close_slave,    &TwoSides::set_timeouts,
                                        &TwoSides::remove,         &TwoSides::exchange_without_port,
                                        &TwoSides::open_impossible};
    for (std::size_t i = 0; i < steps; ++i) {
      (sides.*actions[world.choose("step", actions.size())])();
      sides.look();
    }
  });
  world.run();
}
