#include "kernel_mocks/polled_link.hpp"

#include <algorithm>

#include "kernel_mocks/plc_signals.hpp"

namespace kernel_mocks {

PolledLink::PolledLink(FxDriver& driver, const PolledLinkOptions& options)
    : driver_{driver}, options_{options}, thread_{[this] { run(); }} {}

PolledLink::~PolledLink() {
  {
    const std::scoped_lock lock{mutex_};
    stopping_ = true;
  }
  work_.notify_one();
  changed_.notify_all();
  thread_.join();
  std::unique_lock lock{mutex_};
  changed_.wait(lock, [this] { return callers_ == 0; });
}

tl::expected<PlcLink::Status, FxDriverError> PolledLink::status() noexcept {
  std::unique_lock lock{mutex_};
  ++callers_;
  changed_.wait_for(lock, options_.call_timeout, [this] { return polled_ || stopping_; });
  const auto newest = last_;
  if (--callers_ == 0 && stopping_) changed_.notify_all();
  return newest;
}

PlcLink::Done PolledLink::read_bytes(Device first, std::span<std::byte> into) noexcept {
  Order order{.kind = Kind::read, .device = first, .on = false, .count = into.size()};
  if (order.count > order.bytes.size()) return tl::unexpected{FxDriverError::bad_length};
  auto done = carry_out(order);
  if (done) std::ranges::copy_n(order.bytes.begin(), static_cast<std::ptrdiff_t>(into.size()), into.begin());
  return done;
}

PlcLink::Done PolledLink::write_bytes(Device first, std::span<const std::byte> bytes) noexcept {
  Order order{.kind = Kind::write, .device = first, .on = false, .count = bytes.size()};
  if (order.count > order.bytes.size()) return tl::unexpected{FxDriverError::bad_length};
  std::ranges::copy(bytes, order.bytes.begin());
  return carry_out(order);
}

PlcLink::Done PolledLink::force(Device device, bool on) noexcept {
  Order order{.kind = Kind::force, .device = device, .on = on};
  return carry_out(order);
}

PlcLink::Done PolledLink::carry_out(Order& order) noexcept {
  const auto deadline = Clock::now() + options_.call_timeout;
  std::unique_lock lock{mutex_};
  ++callers_;
  Done result = tl::unexpected{FxDriverError::write_timed_out};
  Slot* slot = nullptr;
  changed_.wait_until(lock, deadline, [&] { return stopping_ || (slot = free_slot()) != nullptr; });
  if (slot != nullptr && !stopping_) {
    slot->order = order;
    slot->turn = ++last_turn_;
    slot->state = State::waiting;
    work_.notify_one();
    changed_.wait_until(lock, deadline, [&] {
      return slot->state == State::done || (stopping_ && slot->state == State::waiting);
    });
    if (slot->state == State::done) {
      result = slot->result;
      order = slot->order;
    }
    // One that is on the line is the thread's until its exchange has ended.
    slot->state = slot->state == State::on_the_line ? State::given_up : State::free;
  }
  --callers_;
  changed_.notify_all();
  return result;
}

PolledLink::Slot* PolledLink::free_slot() noexcept {
  const auto found = std::ranges::find(slots_, State::free, &Slot::state);
  return found == slots_.end() ? nullptr : &*found;
}

PolledLink::Slot* PolledLink::next_in_turn() noexcept {
  Slot* next = nullptr;
  for (Slot& slot : slots_) {
    if (slot.state == State::waiting && (next == nullptr || slot.turn < next->turn)) next = &slot;
  }
  return next;
}

void PolledLink::run() noexcept {
  auto next_poll = Clock::now();
  std::unique_lock lock{mutex_};
  while (!stopping_) {
    if (Slot* const slot = next_in_turn()) {
      slot->state = State::on_the_line;
      lock.unlock();
      // The caller does not look at the slot before it is done, nor after it has given it up.
      slot->result = exchange(slot->order);
      lock.lock();
      slot->state = slot->state == State::given_up ? State::free : State::done;
      changed_.notify_all();
    }
    if (Clock::now() >= next_poll && !stopping_) {
      poll(lock);
      next_poll = Clock::now() + options_.poll_interval;
    }
    work_.wait_until(lock, next_poll, [this] { return stopping_ || next_in_turn() != nullptr; });
  }
}

void PolledLink::poll(std::unique_lock<std::mutex>& lock) noexcept {
  lock.unlock();
  const auto read_at = Clock::now();
  std::array<std::byte, 1> byte{};
  const auto done = driver_.read_bytes(signals::status_byte, byte);
  lock.lock();
  if (done) {
    last_ = Status{byte.front(), read_at};
  } else {
    last_ = tl::unexpected{done.error()};
  }
  polled_ = true;
  changed_.notify_all();
}

PlcLink::Done PolledLink::exchange(Order& order) noexcept {
  const std::span bytes = std::span{order.bytes}.first(order.count);
  switch (order.kind) {
    case Kind::read:
      return driver_.read_bytes(order.device, bytes);
    case Kind::write:
      return driver_.write_bytes(order.device, bytes);
    case Kind::force:
      return driver_.force(order.device, order.on);
  }
  return {};
}

}  // namespace kernel_mocks
