#include "protocol/hardened/master.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "protocol/deadline.hpp"
#include "protocol/hardened/message.hpp"

namespace protocol::hardened {

namespace {

constexpr auto hands_nothing_over = std::memory_order_relaxed;

constexpr CallResult unknown(SharedMemoryError why) noexcept {
  return {.outcome = ExchangeOutcome::unknown, .why = why};
}

}  // namespace

Master::Master(std::string segment_name, const Options& options, ExchangeObserver* observer)
    : Endpoint(std::move(segment_name), options, observer, Side::master),
      take_timeout_(options.take_timeout),
      answer_timeout_(options.answer_timeout),
      message_(std::max(layout().request.capacity_bytes, layout().response.capacity_bytes)) {
  request_.reserve(options.request_bytes_max);
}

Master::~Master() { close(); }

tl::expected<void, SharedMemoryError> Master::open() noexcept {
  if (is_open()) return {};
  if (const auto opened = open_objects(); !opened) return opened;
  session_ = random_number();
  sequence_ = options().first_sequence - 1;
  known_slave_ = 0;
  attach(after_master_attach);
  return {};
}

void Master::close() noexcept {
  if (!is_open()) return;
  give_up_at_once();
  observer().detaching();
  close_objects();
}

bool Master::is_open() const noexcept { return has_objects(); }

CallResult Master::call(std::span<const std::byte> request, std::span<std::byte> into) noexcept {
  if (!write(request)) return {};
  return finish(into);
}

tl::expected<void, SharedMemoryError> Master::write(std::span<const std::byte> request) noexcept {
  if (!is_open()) return tl::unexpected(SharedMemoryError::not_open);
  if (request.size() > options().request_bytes_max)
    return tl::unexpected(SharedMemoryError::request_too_long);
  give_up_at_once();
  observer().submitted(request);
  request_.assign(request.begin(), request.end());
  if (options().rules.sequence_advances) ++sequence_;
  exchange_ = Exchange{};
  const Published published = publish(false);
  if (published == Published::yes) return {};
  end(ExchangeOutcome::not_executed);
  return tl::unexpected(published == Published::no_slave ? SharedMemoryError::no_slave
                                                         : SharedMemoryError::slave_is_busy);
}

tl::expected<std::size_t, SharedMemoryError> Master::get_response(std::span<std::byte> into) noexcept {
  if (!is_open()) return tl::unexpected(SharedMemoryError::not_open);
  if (!exchange_) return 0;
  const CallResult result = finish(into);
  if (result.outcome != ExchangeOutcome::ok) return tl::unexpected(result.why);
  return result.response_bytes;
}

Master::Published Master::publish(bool is_query) noexcept {
  exchange_->is_query = is_query;
  exchange_->take_by = deadline_after(take_timeout_);
  exchange_->answer_by = deadline_after(answer_timeout_, exchange_->take_by);
  for (;;) {
    StateWord found = look_before_use();
    if (found.phase == Phase::raw || found.phase == Phase::down) return Published::no_slave;
    if (found.phase == Phase::lost && move(found, found.in(Phase::idle), hands_nothing_over)) continue;
    if (found.phase != Phase::idle) {
      const auto now = Clock::now();
      if (now >= exchange_->take_by) return Published::slave_is_busy;
      wait(now, exchange_->take_by);
      continue;
    }
    if (is_query && found.generation != exchange_->published.generation) return Published::other_generation;

    observer().filling();
    // Nothing is outstanding, so every ring that is there is stale.
    request_bell().empty();
    if (has_response_bell()) response_bell().empty();
    write_area(layout().request, encode(RequestHeader{.session = session_,
                                                      .sequence = sequence_,
                                                      .expected_slave = expected_slave(found.generation)},
                                        request_, message_));
    if (!options().rules.query_from_first_generation) found = look();
    const StateWord published = found.publishing(sequence_);
    if (!move(found, published, options().orders.publish)) {
      // Somebody who changes the word faster than the area is filled must not keep the call for good.
      if (Clock::now() >= exchange_->take_by) return Published::slave_is_busy;
      continue;
    }
    observer().published();
    exchange_->published = published;
    request_bell().ring();
    return Published::yes;
  }
}

CallResult Master::finish(std::span<std::byte> into) noexcept {
  Attempt attempt = await(into);
  for (unsigned queries = 0; attempt.in_doubt && queries < options().queries_max; ++queries) {
    const Published published = publish(true);
    if (published == Published::no_slave || published == Published::other_generation)
      attempt.result.why = SharedMemoryError::slave_gone;
    if (published != Published::yes) break;
    attempt = await(into);
  }
  if (attempt.in_doubt && !options().rules.doubt_is_kept)
    attempt.result.outcome = ExchangeOutcome::not_executed;
  if (attempt.result.outcome == ExchangeOutcome::ok)
    observer().delivered(into.first(attempt.result.response_bytes));
  end(attempt.result.outcome);
  return attempt.result;
}

Master::Attempt Master::await(std::span<std::byte> into) noexcept {
  const bool is_query = exchange_->is_query;
  const Attempt in_doubt{.in_doubt = true, .result = unknown(SharedMemoryError::unanswered)};
  // A query that was not executed says nothing of its request, which may have been.
  const Attempt dropped =
      is_query ? Attempt{.result = unknown(SharedMemoryError::slave_gone)} : Attempt{.result = {}};
  const Attempt withdrawn = is_query ? in_doubt : dropped;
  for (;;) {
    const StateWord found = look_before_use();
    switch (found.phase) {
      case Phase::response:
        return {.result = accept(found, into)};
      case Phase::idle:
      case Phase::down:
        return dropped;
      case Phase::lost:
        if (!move(found, found.in(Phase::idle), hands_nothing_over)) break;
        return {.result = unknown(SharedMemoryError::slave_gone)};
      case Phase::request: {
        // First the word, then the clock: an answer that is there counts, however late it is.
        const auto now = Clock::now();
        if (now < exchange_->take_by) {
          wait(now, exchange_->take_by);
        } else if (move(found, found.in(Phase::idle), hands_nothing_over, options().rules.withdraw_by_swap)) {
          return withdrawn;
        }
        break;
      }
      case Phase::busy: {
        const auto now = Clock::now();
        if (now < exchange_->answer_by) {
          wait(now, exchange_->answer_by);
        } else if (move(found, found.in(Phase::orphan), hands_nothing_over)) {
          return in_doubt;
        }
        break;
      }
      case Phase::raw:
      case Phase::orphan:
        // Neither side has done that.
        return {.result = unknown(SharedMemoryError::damaged)};
    }
  }
}

CallResult Master::accept(StateWord found, std::span<std::byte> into) noexcept {
  observer().accepted();
  const auto message = read_area(layout().response, message_);
  while (!move(found, found.in(Phase::idle), hands_nothing_over)) {
    // A slave that attaches meanwhile leaves the answer as it is, in its own generation. The copy stands: to read the
    // area once more would be to load its length twice.
    found = look();
    if (found.phase != Phase::response) return unknown(SharedMemoryError::damaged);  // only a foreign writer
  }
  return judge(message, found, into);
}

CallResult Master::judge(const std::optional<std::span<const std::byte>>& message, const StateWord& word,
                         std::span<std::byte> into) noexcept {
  constexpr CallResult damaged = unknown(SharedMemoryError::damaged);
  if (!message || word.sequence != exchange_->published.sequence) return damaged;
  const auto response = decode_response(*message);
  if (!response) return damaged;
  const ResponseHeader& header = response->header;
  const bool is_mine = header.session == session_ && header.sequence == sequence_;
  const bool is_of_unreadable =
      header.status == Status::rejected && header.session == 0 && header.sequence == 0;
  if (!is_mine && !is_of_unreadable) return damaged;
  if (word.generation == exchange_->published.generation) {
    known_slave_ = header.slave;
    known_slave_generation_ = word.generation;
  }
  switch (header.status) {
    case Status::ok:
      break;
    case Status::rejected:
    case Status::wrong_slave:
      // Of a query this says nothing about the attempt before it.
      if (exchange_->is_query) return damaged;
      return {.outcome = ExchangeOutcome::rejected, .why = SharedMemoryError::rejected};
    case Status::answer_too_long:
      return damaged;
  }
  const std::size_t count = std::min(into.size(), response->payload.size());
  std::ranges::copy(response->payload.first(count), into.begin());
  return {.outcome = ExchangeOutcome::ok, .response_bytes = count};
}

void Master::give_up_at_once() noexcept {
  if (!exchange_) return;
  exchange_->take_by = exchange_->answer_by = Clock::time_point::min();
  end(await({}).result.outcome);
}

void Master::end(ExchangeOutcome outcome) noexcept {
  exchange_.reset();
  last_outcome_ = outcome;
  observer().ended(outcome);
}

void Master::wait(Clock::time_point now, Clock::time_point deadline) noexcept {
  if (has_response_bell()) {
    response_bell().wait_until(deadline);
  } else {
    std::this_thread::sleep_until(std::min(deadline, now + options().poll_interval));
  }
}

std::uint64_t Master::expected_slave(std::uint16_t generation) const noexcept {
  constexpr std::uint64_t any = 0;
  return generation == known_slave_generation_ ? known_slave_ : any;
}

void Master::set_timeouts(std::chrono::nanoseconds take, std::chrono::nanoseconds read) noexcept {
  take_timeout_ = take;
  answer_timeout_ = read;
}

std::size_t Master::response_bytes_max() const noexcept { return options().response_bytes_max; }

}  // namespace protocol::hardened
