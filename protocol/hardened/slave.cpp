#include "protocol/hardened/slave.hpp"

#include <utility>

#include "protocol/check.hpp"

namespace protocol::hardened {

Slave::Slave(std::string segment_name, const Options& options, ExchangeObserver* observer)
    : Endpoint(std::move(segment_name), options, observer, Side::slave),
      request_message_(layout().request.capacity_bytes),
      response_message_(layout().response.capacity_bytes),
      store_(layout().response.capacity_bytes) {}

Slave::~Slave() { close(); }

tl::expected<void, SharedMemoryError> Slave::open() noexcept {
  if (is_open()) return {};
  if (const auto opened = open_objects(); !opened) return opened;
  number_ = random_number();
  // A ring that comes after this was for a request that is looked at only after the attach. The other way round the ring
  // of a request that was published in between would be taken, and nobody would look at it.
  if (options().rules.empties_before_look) request_bell().empty();
  attach(after_slave_attach);
  if (!options().rules.empties_before_look) request_bell().empty();
  // A master that waits for the slave before this one need not wait any longer.
  ring_master();
  return {};
}

void Slave::close() noexcept {
  if (!is_open()) return;
  for (;;) {
    const StateWord found = look();
    if (found.phase != Phase::idle && found.phase != Phase::request) break;
    if (move(found, found.in(Phase::down), std::memory_order_relaxed)) break;
  }
  observer().detaching();
  close_objects();
}

bool Slave::is_open() const noexcept { return has_objects(); }

bool Slave::wait_for_request() noexcept {
  PLC_CHECK(is_open());
  while (!stop_requested_.load()) {
    request_bell().wait();
    if (stop_requested_.load()) {
      stop_ring_taken_ = true;
      return false;
    }
    // Before the take nothing is read, so the take orders what is.
    taken_ = options().rules.take_before_read ? look() : look_before_use();
    if (options().rules.phase_decides && taken_.phase != Phase::request) continue;
    if (!options().rules.take_before_read) read_ = read_area(layout().request, request_message_);
    const StateWord busy = taken_.in(Phase::busy);
    if (!move(taken_, busy, options().orders.take, options().rules.phase_decides)) continue;
    taken_ = busy;
    observer().taken();
    if (read_taken_request()) return true;
  }
  // Leaves the count as if there had been no stop.
  if (!std::exchange(stop_ring_taken_, true)) request_bell().try_take();
  return false;
}

bool Slave::read_taken_request() noexcept {
  if (options().rules.take_before_read) read_ = read_area(layout().request, request_message_);
  request_ = {};
  const auto decoded = read_ ? decode_request(*read_) : tl::unexpected(MessageError::too_short);
  if (!decoded) {
    answer(Status::rejected, {});
    return false;
  }
  request_ = *decoded;
  const RequestHeader& header = request_.header;
  if (header.expected_slave != 0 && header.expected_slave != number_) {
    answer(Status::wrong_slave, {});
    return false;
  }
  if (options().rules.duplicate_store) {
    if (const auto answered = store_.find(header.session, header.sequence)) {
      hand_over(*answered);
      return false;
    }
  }
  return true;
}

std::span<const std::byte> Slave::read_request() noexcept {
  observer().executed(request_.payload);
  return request_.payload;
}

void Slave::write_response(std::span<const std::byte> response) noexcept {
  const bool fits = response.size() <= options().response_bytes_max;
  answer(fits ? Status::ok : Status::answer_too_long, fits ? response : std::span<const std::byte>{});
}

void Slave::answer(Status status, std::span<const std::byte> payload) noexcept {
  const auto message = encode(ResponseHeader{.status = status,
                                             .session = request_.header.session,
                                             .sequence = request_.header.sequence,
                                             .slave = number_},
                              payload, response_message_);
  const bool was_executed = status == Status::ok || status == Status::answer_too_long;
  if (was_executed) store_.put(request_.header.session, request_.header.sequence, message);
  hand_over(message);
}

void Slave::hand_over(std::span<const std::byte> message) noexcept {
  write_area(layout().response, message);
  observer().answered(message.subspan(header_bytes));
  const Rules& rules = options().rules;
  if (move(taken_, taken_.in(Phase::response), options().orders.answer, rules.answer_by_swap)) {
    observer().announced();
    return ring_master();
  }
  // The master has given up, perhaps another one has attached since, more than once: the answer is dropped.
  for (;;) {
    const StateWord found = look();
    if (found.phase != Phase::orphan) return;  // only a foreign writer
    if (move(found, found.in(Phase::idle), options().orders.drop)) return ring_master();
  }
}

void Slave::ring_master() noexcept {
  if (has_response_bell()) response_bell().ring();
}

void Slave::request_stop() noexcept {
  if (stop_requested_.exchange(true)) return;
  if (is_open()) request_bell().ring();
}

}  // namespace protocol::hardened
