// The emulator's side of the hardened handoff against a foreign writer: before it opens, before each wake, when it has taken a
// request, when it has written an answer, before it closes.
//
//   byte   0          bit 0: one doorbell
//   from   1          a script (hardened_peer.hpp). The PLC takes a byte of it for each answer: its length, a remainder by 40
//
// A second decoder reads what lies in the area after the take: what is whole, for this slave, and not the request that was
// executed last is executed, with these bytes; nothing else is. Each take is answered, with the message that follows from that;
// the slave makes the moves that are its own, and writes nowhere but into the response area.
//
// A slave that waits for a ring which does not come would wait for good, so it is woken only when a request is there, and stops
// behind one that it has not executed. What rings without requests do is seen by hostile-hardened-slave.

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/hardened_peer.hpp"
#include "protocol/hardened/slave.hpp"
#include "protocol/hardened/state_word.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

namespace hardened = protocol::hardened;
namespace reference = fuzz::reference;
using fuzz::ForeignWriter;
using hardened::Phase;
using hardened::Status;
using Bytes = std::vector<std::byte>;

Bytes copy_of(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }

bool is_in(std::uint32_t word, Phase phase) { return (word & 7U) == static_cast<std::uint32_t>(phase); }

std::uint32_t word_in(std::uint32_t word, Phase phase) {
  return (word & ~7U) | static_cast<std::uint32_t>(phase);
}

/// Lets the writer act within a step of the slave, and compares what the slave does.
class Judge final : public protocol::ExchangeObserver {
 public:
  Judge(ForeignWriter& writer, const hardened::Options& options)
      : writer_{writer}, layout_{fuzz::layout_of(options)}, options_{options} {}

  void serves(hardened::Slave& slave) { slave_ = &slave; }

  void taken() noexcept override {
    taken_ = writer_.word();
    writer_.act(right_);
    at_take_ = copy_of(writer_.segment());
    request_ = {};
    const auto message = writer_.message_in_area();
    is_whole_ = message && !reference::decode(reference::Kind::request, *message, request_);
    executed_ = false;
  }

  void executed(std::span<const std::byte> payload) noexcept override {
    executed_ = true;
    holds(is_whole_ && std::ranges::equal(payload, request_.payload),
          "what is executed lay in the area, whole");
    holds(last_answer_.empty() || !is_last(), "no request is executed twice in a row");
  }

  void answered(std::span<const std::byte> payload) noexcept override {
    const Bytes answer = copy_of(reference::message_around(payload));
    holds(writes_only_answer(answer), "nothing is written but the answer");
    check_answer(answer);
    if (executed_) {
      last_answer_ = answer;
      last_request_ = request_;
    } else {
      slave_->request_stop();
    }
    right_ = {.session = request_.session, .sequence = request_.sequence, .slave = number_};
    writer_.act(right_);
    at_answer_ = copy_of(writer_.segment());
    word_at_answer_ = writer_.word();
  }

  [[nodiscard]] const ForeignWriter::Right& right() const noexcept { return right_; }
  /// How long the answer is that the PLC is about to give.
  void will_answer(std::size_t bytes) noexcept { answer_bytes_ = bytes; }

  /// The slave has done with one take.
  void check() {
    std::uint32_t expected = word_at_answer_;
    if (word_at_answer_ == taken_) expected = word_in(taken_, Phase::response);
    if (is_in(word_at_answer_, Phase::orphan)) expected = word_in(word_at_answer_, Phase::idle);
    holds(writer_.word() == expected, "an answer is announced by the one who took the request, or dropped");
    holds(std::ranges::equal(writer_.segment().subspan(4), std::span{at_answer_}.subspan(4)),
          "nothing is written once the answer is there");
    ltsim::expect(broken_ == nullptr, broken_);
  }

 private:
  /// Nothing is thrown through the slave: the first broken promise is kept.
  void holds(bool promise, const char* text) noexcept {
    if (!promise && broken_ == nullptr) broken_ = text;
  }

  [[nodiscard]] bool is_last() const {
    return request_.session == last_request_.session && request_.sequence == last_request_.sequence;
  }

  [[nodiscard]] bool writes_only_answer(std::span<const std::byte> answer) const {
    if (answer.size() > layout_.response.capacity_bytes) return false;
    Bytes expected = at_take_;
    const auto length = static_cast<std::uint32_t>(answer.size());
    std::memcpy(expected.data() + layout_.response.length_offset, &length, sizeof length);
    std::ranges::copy(answer, expected.begin() + static_cast<std::ptrdiff_t>(layout_.response.bytes_offset));
    return std::ranges::equal(expected, writer_.segment());
  }

  void check_answer(const Bytes& bytes) {
    reference::Message answer;
    if (reference::decode(reference::Kind::response, bytes, answer))
      return holds(false, "an answer is whole");
    if (number_ == 0) number_ = answer.slave;
    holds(answer.slave == number_ && number_ != 0, "each answer tells whose it is");
    holds(answer.session == request_.session && answer.sequence == request_.sequence,
          "an answer tells what it answers");
    const bool is_for_this = request_.slave == 0 || request_.slave == number_;
    holds(executed_ == (is_whole_ && is_for_this && (last_answer_.empty() || !is_last())),
          "what is whole and new is executed, and nothing else");
    if (executed_) {
      const bool fits = answer_bytes_ <= options_.response_bytes_max;
      holds(answer.flags_or_status == static_cast<std::uint32_t>(fits ? Status::ok : Status::answer_too_long),
            "an answer says whether it had room");
      holds(answer.payload.size() == (fits ? answer_bytes_ : 0), "the answer is the PLC's");
    } else if (is_whole_ && is_for_this) {
      holds(bytes == last_answer_, "a request that comes again gets the same answer");
    } else {
      holds(answer.flags_or_status ==
                static_cast<std::uint32_t>(is_whole_ ? Status::wrong_slave : Status::rejected),
            "who refuses says why");
      holds(answer.payload.empty(), "a refusal carries nothing");
    }
  }

  ForeignWriter& writer_;
  protocol::SegmentLayout layout_;
  const hardened::Options& options_;
  hardened::Slave* slave_ = nullptr;
  const char* broken_ = nullptr;
  ForeignWriter::Right right_;
  std::uint64_t number_ = 0;  // of the slave, once it has answered
  // Of this take.
  std::uint32_t taken_ = 0;
  std::uint32_t word_at_answer_ = 0;
  Bytes at_take_, at_answer_;
  reference::Message request_;
  bool is_whole_ = false;
  bool executed_ = false;
  std::size_t answer_bytes_ = 0;
  // Of what was executed last.
  reference::Message last_request_;
  Bytes last_answer_;
};

/// @param word  before the slave attached
std::uint32_t attached_word(std::uint32_t word) {
  const std::uint32_t generation = ((word >> 3U) + 1U) & 0x1FFFU;
  const Phase phase = is_in(word, Phase::busy) || is_in(word, Phase::lost) ? Phase::lost
                      : is_in(word, Phase::response)                       ? Phase::response
                                                                           : Phase::idle;
  return word_in((word & 0xFFFF'0000U) | generation << 3U, phase);
}

/// One request, from the wake to the answer.
/// @return whether it was executed
bool serve(hardened::Slave& slave, Judge& judge, fuzz::Script& script) {
  constexpr unsigned answers_count = 40;  // there is room for 24 bytes
  if (!slave.wait_for_request()) return false;
  static_cast<void>(slave.read_request());
  const Bytes answer(script.byte() % answers_count, std::byte{0x5A});
  judge.will_answer(answer.size());
  slave.write_response(answer);
  return true;
}

}  // namespace

FUZZ_TARGET("hardened-slave", {}, "the emulator's side of the hardened handoff against a foreign writer") {
  fuzz::Script script{input};
  hardened::Options options = fuzz::small_hardened_options();
  const std::string name = "fuzz-hardened-slave-" + std::to_string(getpid());
  const fuzz::MadeSegment<hardened::Slave> made{name, options};
  if (script.byte() % 2U == 1) options.doorbells = hardened::Options::Doorbells::one;
  ForeignWriter writer{name, options, reference::Kind::request, script};
  Judge judge{writer, options};
  hardened::Slave slave{name, options, &judge};
  judge.serves(slave);

  writer.act(judge.right());
  const std::uint32_t before = writer.word();
  const int rings = writer.rings(0);
  if (const auto opened = slave.open(); !opened) {
    ltsim::expect(fuzz::is_refusal_to_open(opened.error()) && !slave.is_open(), "a refusal has a reason");
    return;
  }
  made.remove();
  ltsim::expect(writer.word() == attached_word(before), "an attach makes of the word what the table says");
  ltsim::expect(rings - writer.rings(0) <= fuzz::emptied_rings_max,
                "the work of an attach does not grow with the rings");
  bool goes_on = true;
  while (goes_on && !script.is_over()) {
    writer.act(judge.right());
    if (!is_in(writer.word(), Phase::request) || writer.rings(0) == 0) continue;
    goes_on = serve(slave, judge, script);
    judge.check();
  }
  writer.act(judge.right());
  const std::uint32_t at_end = writer.word();
  slave.close();
  const bool is_free = is_in(at_end, Phase::idle) || is_in(at_end, Phase::request);
  ltsim::expect(writer.word() == (is_free ? word_in(at_end, Phase::down) : at_end),
                "who closes says so where nothing is under way");
}
