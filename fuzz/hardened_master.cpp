// The kernel's side of the hardened handoff against a foreign writer: before it opens, before each call, when it is about to fill
// the request area, when it has published, when it has seen an answer or has given one up, before it closes.
//
//   byte   0          bit 0: one doorbell; bits 1, 2: how many queries, 0 to 3
//   from   1          before the opening a script (hardened_peer.hpp), then calls: how it is called, by its remainder by 3 (call(),
//                     write() and get_response(), write() alone), bytes of the request (a remainder by 20, there is room for 16), room
//                     for the answer (a remainder by 32), and the scripts that are asked for
//
// All time-outs are zero, so nothing is waited for, and a call has to end without anybody's help. It has one outcome. It is ok
// if, and only if, a second decoder finds in the area a whole answer to this very request, and says what that decoder reads.

#include <semaphore.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/hardened_peer.hpp"
#include "protocol/hardened/master.hpp"
#include "protocol/hardened/state_word.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

namespace hardened = protocol::hardened;
namespace reference = fuzz::reference;
using fuzz::ForeignWriter;
using hardened::CallResult;
using hardened::Phase;
using hardened::Status;
using protocol::ExchangeOutcome;
using protocol::SharedMemoryError;

bool is_in(std::uint32_t word, Phase phase) { return (word & 7U) == static_cast<std::uint32_t>(phase); }

/// Lets the writer act within a call, and says what must come of it.
class Judge final : public protocol::ExchangeObserver {
 public:
  Judge(ForeignWriter& writer, const hardened::Options& options)
      : writer_{writer}, layout_{fuzz::layout_of(options)}, options_{options} {}

  void submitted(std::span<const std::byte> request) noexcept override {
    holds(submitted_count_ == ended_count_, "one request ends before the next");
    ++submitted_count_;
    request_.assign(request.begin(), request.end());
    fillings_count_ = published_count_ = 0;
    expected_.reset();
  }

  void filling() noexcept override {
    holds(++fillings_count_ <= 1 + options_.queries_max, "no attempt begins again when its time is over");
    writer_.act(right_);
    rings_ = writer_.rings(0);
  }

  void published() noexcept override {
    holds(rings_ - writer_.rings(0) <= fuzz::emptied_rings_max,
          "the work of a call does not grow with the rings");
    const bool is_query = ++published_count_ > 1;
    const std::uint32_t word = writer_.word();
    holds(is_in(word, Phase::request), "what is published is there");
    reference::Message message;
    const auto in_area = request_in_area();
    holds(in_area && !reference::decode(reference::Kind::request, *in_area, message) &&
              message.payload == request_,
          "what is published is the request, whole");
    holds(message.sequence == submitted_count_ && word >> 16U == (submitted_count_ & 0xFFFFU),
          "a request has the next number");
    if (session_ == 0) session_ = message.session;
    holds(message.session == session_ && session_ != 0, "a session has one number");
    if (is_query)
      holds((word >> 3U & 0x1FFFU) == (published_ >> 3U & 0x1FFFU), "a query stays in its generation");
    else
      published_ = word;
    right_ = {.session = session_, .sequence = message.sequence, .slave = slave_number};
    writer_.act(right_);
  }

  /// The slave may finish what was given up before it is asked for again.
  void moved(std::uint32_t /*from*/, std::uint32_t to) noexcept override {
    if (is_under_way() && is_in(to, Phase::orphan)) writer_.act(right_);
  }

  void accepted() noexcept override {
    writer_.act(right_);
    expected_ = answer_in_area();
  }

  void delivered(std::span<const std::byte> response) noexcept override {
    holds(expected_.has_value() && expected_->outcome == ExchangeOutcome::ok &&
              response.size() <= answer_.payload.size() &&
              std::ranges::equal(response, std::span{answer_.payload}.first(response.size())),
          "what is delivered is a whole answer to this request");
  }

  void ended(ExchangeOutcome outcome) noexcept override {
    ++ended_count_;
    outcome_ = outcome;
    holds(submitted_count_ == ended_count_, "a request ends once");
    const auto expected = expected_ ? std::optional(expected_->outcome) : std::nullopt;
    holds(expected ? outcome == *expected
                   : outcome == ExchangeOutcome::not_executed || outcome == ExchangeOutcome::unknown,
          "a request ends as the answer says, or without one");
    holds(published_count_ > 0 || outcome == ExchangeOutcome::not_executed,
          "what was not published is not executed");
  }

  /// What the kernel is told of a request that has ended.
  /// @param room  for the answer
  void check(const CallResult& told, std::size_t room) {
    ltsim::expect(told.outcome == outcome_, "the kernel is told how its request ended");
    if (told.outcome == ExchangeOutcome::ok) {
      ltsim::expect(told.response_bytes == std::min(room, answer_.payload.size()),
                    "as much is copied as there is room for");
    } else if (expected_) {
      ltsim::expect(told.why == expected_->why, "the kernel is told why");
    }
  }
  void check() const { ltsim::expect(broken_ == nullptr, broken_); }

  [[nodiscard]] bool is_under_way() const noexcept { return submitted_count_ != ended_count_; }
  [[nodiscard]] const ForeignWriter::Right& right() const noexcept { return right_; }

 private:
  static constexpr std::uint64_t slave_number = 0x51A7E;

  /// Nothing is thrown through the master: the first broken promise is kept.
  void holds(bool promise, const char* text) noexcept {
    if (!promise && broken_ == nullptr) broken_ = text;
  }

  [[nodiscard]] std::optional<std::span<const std::byte>> request_in_area() const noexcept {
    std::uint32_t length = 0;
    std::memcpy(&length, writer_.segment().data() + layout_.request.length_offset, sizeof length);
    if (length > layout_.request.capacity_bytes) return std::nullopt;
    return writer_.segment().subspan(layout_.request.bytes_offset, length);
  }

  /// How the request must end by what lies in the area now.
  [[nodiscard]] CallResult answer_in_area() {
    constexpr CallResult damaged{.outcome = ExchangeOutcome::unknown, .why = SharedMemoryError::damaged};
    const std::uint32_t word = writer_.word();
    const auto message = writer_.message_in_area();
    answer_ = {};
    if (!is_in(word, Phase::response) || word >> 16U != published_ >> 16U || !message ||
        reference::decode(reference::Kind::response, *message, answer_)) {
      return damaged;
    }
    const auto status = static_cast<Status>(answer_.flags_or_status);
    const bool is_mine = answer_.session == session_ && answer_.sequence == submitted_count_;
    const bool is_of_unreadable = status == Status::rejected && answer_.session == 0 && answer_.sequence == 0;
    if (!is_mine && !is_of_unreadable) return damaged;
    if (status == Status::ok) return {.outcome = ExchangeOutcome::ok};
    if (status == Status::answer_too_long || published_count_ > 1) return damaged;
    return {.outcome = ExchangeOutcome::rejected, .why = SharedMemoryError::rejected};
  }

  ForeignWriter& writer_;
  protocol::SegmentLayout layout_;
  const hardened::Options& options_;
  const char* broken_ = nullptr;
  ForeignWriter::Right right_{.slave = slave_number};
  std::uint64_t session_ = 0;
  std::uint64_t submitted_count_ = 0;
  std::uint64_t ended_count_ = 0;
  ExchangeOutcome outcome_ = ExchangeOutcome::not_executed;
  // Of this request.
  std::vector<std::byte> request_;
  unsigned fillings_count_ = 0;
  unsigned published_count_ = 0;
  std::uint32_t published_ = 0;  // the word, of the first attempt
  int rings_ = 0;
  std::optional<CallResult> expected_;  // once an answer was seen
  reference::Message answer_;
};

/// @param word  before the master attached
std::uint32_t attached_word(std::uint32_t word) {
  if (is_in(word, Phase::raw) || is_in(word, Phase::down)) return word;
  const std::uint32_t generation = ((word >> 3U) + 1U) & 0x1FFFU;
  const Phase phase = is_in(word, Phase::busy) || is_in(word, Phase::orphan) ? Phase::orphan : Phase::idle;
  return (word & 0xFFFF'0000U) | generation << 3U | static_cast<std::uint32_t>(phase);
}

constexpr std::byte guard{0xA5};

/// One request.
void call(hardened::Master& master, Judge& judge, fuzz::Script& script, const hardened::Options& options) {
  std::array<std::byte, 20> request;
  request.fill(std::byte{0x3C});
  std::array<std::byte, 40> buffer;
  buffer.fill(guard);
  const unsigned how = script.byte() % 3U;
  const auto sent = std::span{request}.first(script.byte() % request.size());
  const auto into = std::span{buffer}.first(script.byte() % 32U);
  std::size_t count = 0;
  if (sent.size() > options.request_bytes_max) {
    const auto written = master.write(sent);
    ltsim::expect(written == tl::unexpected{SharedMemoryError::request_too_long},
                  "a request that has no room is refused");
  } else if (how == 0) {
    const CallResult result = master.call(sent, into);
    judge.check(result, into.size());
    count = result.response_bytes;
  } else if (const auto written = master.write(sent); !written) {
    ltsim::expect((written.error() == SharedMemoryError::no_slave ||
                   written.error() == SharedMemoryError::slave_is_busy) &&
                      master.last_outcome() == ExchangeOutcome::not_executed,
                  "what is not published says why");
  } else if (how == 1) {
    const auto read = master.get_response(into);
    count = read.value_or(0);
    judge.check(read ? CallResult{.outcome = ExchangeOutcome::ok, .response_bytes = count}
                     : CallResult{.outcome = master.last_outcome(), .why = read.error()},
                into.size());
    ltsim::expect(master.get_response(into) == 0U, "an answer is there once");
  }
  ltsim::expect(count <= into.size() && std::ranges::all_of(std::span{buffer}.subspan(count),
                                                            [](std::byte byte) { return byte == guard; }),
                "nothing is written behind the answer");
}

}  // namespace

FUZZ_TARGET("hardened-master", {}, "the kernel's side of the hardened handoff against a foreign writer") {
  fuzz::Script script{input};
  hardened::Options options = fuzz::small_hardened_options();
  options.take_timeout = options.answer_timeout = options.poll_interval = std::chrono::nanoseconds{0};
  const std::string name = "fuzz-hardened-master-" + std::to_string(getpid());
  const fuzz::MadeSegment<hardened::Master> made{name, options};
  const unsigned chosen = script.byte();
  if ((chosen & 1U) != 0) options.doorbells = hardened::Options::Doorbells::one;
  options.queries_max = chosen >> 1U & 3U;
  ForeignWriter writer{name, options, reference::Kind::response, script};
  Judge judge{writer, options};
  hardened::Master master{name, options, &judge};

  writer.act(judge.right());
  const std::uint32_t before = writer.word();
  if (const auto opened = master.open(); !opened) {
    ltsim::expect(fuzz::is_refusal_to_open(opened.error()) && !master.is_open(), "a refusal has a reason");
    return;
  }
  made.remove();
  ltsim::expect(writer.word() == attached_word(before), "an attach makes of the word what the table says");
  while (!script.is_over()) {
    writer.act(judge.right());
    call(master, judge, script, options);
    judge.check();
  }
  master.close();
  judge.check();
  ltsim::expect(!judge.is_under_way(), "who closes leaves nothing under way");
}
