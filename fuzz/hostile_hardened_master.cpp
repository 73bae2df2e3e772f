// The kernel's side of the hardened handoff against a peer who writes what he likes into the segment, and rings, between any two
// accesses.
//
// Each request ends once, within its time-outs; what is delivered as its answer, or ends it as rejected, the peer has put there
// whole, with the session and the number of this request. No more bytes are written than there is room for, the length is loaded
// once, no access is outside of the segment (the world sees to that).

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>
#include <vector>

#include "fuzz/hostile_hardened_peer.hpp"
#include "protocol/hardened/master.hpp"
#include "sim_clock/scenario/fuzz_scenario.hpp"

namespace {

using namespace std::chrono_literals;
using protocol::ExchangeOutcome;
namespace hardened = protocol::hardened;
namespace reference = fuzz::reference;

hardened::Options choose_options(ltsim::World& world) {
  const std::size_t chosen = world.choose("options", 6);
  hardened::Options options = fuzz::small_hardened_options();
  if (chosen % 2 == 1) options.doorbells = hardened::Options::Doorbells::one;
  options.queries_max = static_cast<unsigned>((chosen / 2 + 1) % 3);
  options.take_timeout = options.answer_timeout = 5ms;
  return options;
}

/// Counts how requests end, and keeps what was called an answer until it is known what the peer has put there.
class Judge final : public protocol::ExchangeObserver {
 public:
  explicit Judge(ltsim::World& world) : world_{world} {}

  void submitted(std::span<const std::byte> /*request*/) noexcept override {
    world_.require(submitted_count_ == ended_count_, "one request ends before the next");
    ++submitted_count_;
    answer_.clear();
  }
  void delivered(std::span<const std::byte> response) noexcept override {
    answer_.assign(response.begin(), response.end());
  }
  void ended(ExchangeOutcome outcome) noexcept override {
    ++ended_count_;
    world_.require(submitted_count_ == ended_count_, "a request ends once");
    if (outcome == ExchangeOutcome::ok || outcome == ExchangeOutcome::rejected)
      believed_.push_back({outcome, submitted_count_, answer_});
  }

  /// @param session  of the master
  /// @param messages  that the peer has put there
  void check(std::uint64_t session, const std::vector<reference::Message>& messages) const {
    for (const Believed& believed : believed_) {
      world_.require(
          std::ranges::any_of(
              messages, [&](const reference::Message& message) { return tells(message, session, believed); }),
          "a request ends by a whole answer to it");
    }
  }
  [[nodiscard]] bool is_under_way() const noexcept { return submitted_count_ != ended_count_; }

 private:
  struct Believed {
    ExchangeOutcome outcome;
    std::uint64_t sequence;
    std::vector<std::byte> answer;
  };

  static bool tells(const reference::Message& message, std::uint64_t session, const Believed& believed) {
    const bool is_of_this = message.session == session && message.sequence == believed.sequence;
    const auto status = static_cast<hardened::Status>(message.flags_or_status);
    if (believed.outcome == ExchangeOutcome::rejected) {
      const bool is_of_unreadable = message.session == 0 && message.sequence == 0;
      return (status == hardened::Status::rejected && (is_of_this || is_of_unreadable)) ||
             (status == hardened::Status::wrong_slave && is_of_this);
    }
    return is_of_this && status == hardened::Status::ok && believed.answer.size() <= message.payload.size() &&
           std::ranges::equal(believed.answer, std::span{message.payload}.first(believed.answer.size()));
  }

  ltsim::World& world_;
  std::uint64_t submitted_count_ = 0;
  std::uint64_t ended_count_ = 0;
  std::vector<std::byte> answer_;  // to the request that was submitted last
  std::vector<Believed> believed_;
};

void call(ltsim::World& world, hardened::Master& master) {
  constexpr std::byte guard{0xA5};
  constexpr std::array<std::byte, 16> request{};
  std::array<std::byte, 32> buffer;
  buffer.fill(guard);
  const auto sent = std::span{request}.first(request.size() - world.choose("request", request.size() + 1));
  const auto into = std::span{buffer}.first(buffer.size() - world.choose("room", buffer.size() + 1));
  const hardened::CallResult result = master.call(sent, into);
  world.require(result.response_bytes <= into.size() &&
                    (result.outcome == ExchangeOutcome::ok || result.response_bytes == 0),
                "no more bytes are read than there is room for");
  world.require(std::ranges::all_of(std::span{buffer}.subspan(result.response_bytes),
                                    [&](std::byte byte) { return byte == guard; }),
                "no byte is written behind those that are read");
  world.require(result.outcome == master.last_outcome(), "the kernel is told how its request ended");
}

}  // namespace

FUZZ_SCENARIO(
    "hostile-hardened-master",
    "the kernel's side of the hardened handoff against a peer who rewrites the segment between any two "
    "accesses, and rings") {
  constexpr std::size_t requests_max = 3;
  constexpr auto time_to_react = 5ms;
  const hardened::Options options = choose_options(world);
  const protocol::SegmentLayout layout = fuzz::layout_of(options);
  fuzz::leave_to_foreign_writers(world, layout, {.phase = hardened::Phase::idle}, layout.response,
                                 "segment.response-length");
  const std::size_t requests = 1 + world.choose("requests", requests_max);
  ltsim::SimTime held_up{0};
  world.whenever_held_up([&](ltsim::SimTime time) { held_up += time; });
  bool is_open = false;
  bool has_closed = false;
  Judge judge{world};
  world.process("kernel").start("main", [&] {
    hardened::Master master{fuzz::hardened_segment, options, &judge};
    world.require(master.open().has_value(), "the segment can be opened");
    is_open = true;
    const auto time_max =
        (options.take_timeout + options.answer_timeout) * (1 + options.queries_max) + time_to_react;
    for (std::size_t i = 0; i < requests; ++i) {
      std::this_thread::sleep_for(1ms);
      const auto begin = world.now();
      const auto held_up_before = held_up;
      call(world, master);
      world.require(world.now() - begin <= time_max + (held_up - held_up_before),
                    "a call ends within its time-outs");
    }
    master.close();
    world.require(!judge.is_under_way(), "who closes leaves nothing under way");
    has_closed = true;
  });
  world.process("emulator").start("main", [&] {
    while (!is_open) std::this_thread::sleep_for(1ms);
    // With one doorbell nobody would hear the other.
    const bool has_two = options.doorbells == hardened::Options::Doorbells::two;
    fuzz::HostilePeer peer{world, layout, reference::Kind::response, has_two ? ".response" : ".request"};
    while (!has_closed) peer.act();
    judge.check(peer.session(), peer.messages());
  });
  world.run();
}
