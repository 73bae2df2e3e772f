#include "emulator_models/soft_plc/gateway.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "protocol/deadline.hpp"

namespace emulator_models::soft_plc {

class Gateway::Ticket {
 public:
  explicit Ticket(GatewayRequest asked) : request{std::move(asked)} {
    for (const GatewayItem& item : request.items)
      answer.read.emplace_back(item.written.empty() ? item.section.bytes : 0);
  }

  const GatewayRequest request;
  GatewayAnswer answer;          ///< with room for what is read, until it becomes the result
  std::optional<Result> result;  ///< guarded by the gateway's mutex
};

namespace {

std::span<std::byte> area_of(const CycleImage& image, Area area) noexcept {
  if (area == Area::inputs) return image.inputs;
  return area == Area::outputs ? image.outputs : image.memory;
}

/// @param read  of the length that the item asks for
void carry_out(const GatewayItem& item, const CycleImage& image, std::span<std::byte> read) noexcept {
  const std::span<std::byte> at = area_of(image, item.area).subspan(item.section.first);
  if (item.bit) {
    const std::byte mask{static_cast<unsigned char>(1U << *item.bit)};
    at[0] = item.written[0] == std::byte{0} ? at[0] & ~mask : at[0] | mask;
  } else if (item.written.empty()) {
    std::ranges::copy(at.first(read.size()), read.begin());
  } else {
    std::ranges::copy(item.written, at.begin());
  }
}

}  // namespace

std::string_view to_string(GatewayError error) noexcept {
  switch (error) {
    case GatewayError::cycle_unknown:
      return "there is no such cycle; cycles are numbered from 0 in the order of the configuration";
    case GatewayError::request_too_long:
      return "a request has 1 to 16 items of 1 to 1024 bytes together; split it";
    case GatewayError::out_of_range:
      return "the item lies outside of the areas I, Q and M of this cycle";
    case GatewayError::not_writable:
      return "inputs and outputs are read only; write to memory, and let the program set the output";
    case GatewayError::bad_bit:
      return "a bit is 0 to 7 and is written with one byte, 0 for off; read the byte that holds it";
    case GatewayError::owned_by_other_cycle:
      return "another cycle sends these words; write to the cycle that owns them";
    case GatewayError::queue_full:
      return "too many requests wait for this cycle; try again later";
    case GatewayError::timed_out:
      return "no scan of the cycle has served the request in time; it is given up, nothing was written";
    case GatewayError::closed:
      return "the PLC is being shut down or reconfigured; ask the new one";
  }
  return "";
}

Gateway::Gateway(const GatewayLimits& limits, const std::vector<CycleImage>& images,
                 const VariableExchange& exchange)
    : exchange_{exchange}, limits_{limits} {
  for (const CycleImage& image : images) {
    Cycle& cycle = cycles_.emplace_back();
    cycle.queue.reserve(limits_.queue_max);
    for (const Area area : {Area::inputs, Area::outputs, Area::memory})
      cycle.bytes[static_cast<std::size_t>(area)] = area_of(image, area).size();
  }
}

tl::expected<void, GatewayError> Gateway::check_item(const GatewayItem& item,
                                                     std::size_t cycle) const noexcept {
  const Section section{item.section.first, item.written.empty() ? item.section.bytes : item.written.size()};
  const std::size_t area_bytes = cycles_[cycle].bytes[static_cast<std::size_t>(item.area)];
  if (section.bytes == 0 || !section.fits(area_bytes)) return tl::unexpected{GatewayError::out_of_range};
  if (item.bit && (*item.bit > 7 || item.written.size() != 1)) return tl::unexpected{GatewayError::bad_bit};
  if (item.written.empty()) return {};
  if (item.area != Area::memory) return tl::unexpected{GatewayError::not_writable};
  if (exchange_.is_received(cycle, section)) return tl::unexpected{GatewayError::owned_by_other_cycle};
  return {};
}

tl::expected<void, GatewayError> Gateway::check(const GatewayRequest& request) const noexcept {
  if (request.cycle >= cycles_.size()) return tl::unexpected{GatewayError::cycle_unknown};
  if (request.items.empty() || request.items.size() > GatewayRequest::items_max)
    return tl::unexpected{GatewayError::request_too_long};
  std::size_t bytes = 0;
  for (const GatewayItem& item : request.items) {
    if (const auto checked = check_item(item, request.cycle); !checked) return checked;
    bytes += item.written.empty() ? item.section.bytes : item.written.size();
  }
  if (bytes > GatewayRequest::bytes_max) return tl::unexpected{GatewayError::request_too_long};
  return {};
}

tl::expected<std::shared_ptr<Gateway::Ticket>, GatewayError> Gateway::submit(GatewayRequest request) {
  const std::lock_guard lock{mutex_};
  auto checked = check(request);
  if (closed_) checked = tl::unexpected{GatewayError::closed};
  if (checked && cycles_[request.cycle].queue.size() >= limits_.queue_max)
    checked = tl::unexpected{GatewayError::queue_full};
  if (!checked) {
    ++refused_count_;
    return tl::unexpected{checked.error()};
  }
  auto ticket = std::make_shared<Ticket>(std::move(request));
  cycles_[ticket->request.cycle].queue.push_back(ticket);
  return ticket;
}

Gateway::Result Gateway::take(const std::shared_ptr<Ticket>& ticket, bool keep_waiting) {
  const std::lock_guard lock{mutex_};
  if (ticket->result) return *ticket->result;
#ifdef LTSIM_MUTANT_GATEWAY_KEEPS_GIVEN_UP  // what is given up stays in the queue
  keep_waiting = true;
#endif
  if (!keep_waiting) std::erase(cycles_[ticket->request.cycle].queue, ticket);
  return tl::unexpected{GatewayError::timed_out};
}

Gateway::Result Gateway::exchange(GatewayRequest request, std::chrono::nanoseconds timeout) {
  const auto deadline = protocol::deadline_after(timeout);
  const auto ticket = submit(std::move(request));
  if (!ticket) return tl::unexpected{ticket.error()};
  {
    std::unique_lock<std::mutex> lock{mutex_};
    answered_.wait_until(lock, deadline, [&] { return (*ticket)->result.has_value(); });
  }
  return take(*ticket);
}

void Gateway::tell_of_writes(std::size_t cycle, PlcObserver& observer) const noexcept {
  const auto& queue = cycles_[cycle].queue;
  for (std::size_t i = 0; i < std::min(limits_.requests_per_scan_max, queue.size()); ++i) {
    for (const GatewayItem& item : queue[i]->request.items) {
      if (!item.written.empty()) observer.gateway_writes(cycle, item);
    }
  }
}

void Gateway::serve(std::size_t cycle, const CycleImage& image, PlcObserver* observer) noexcept {
  const std::lock_guard lock{mutex_};
  if (observer != nullptr) tell_of_writes(cycle, *observer);
  Cycle& served = cycles_[cycle];
  ++served.scan_number;
  const std::size_t count = std::min(limits_.requests_per_scan_max, served.queue.size());
  if (count == 0) return;
  for (std::size_t i = 0; i < count; ++i) {
    Ticket& ticket = *served.queue[i];
    for (std::size_t k = 0; k < ticket.request.items.size(); ++k)
      carry_out(ticket.request.items[k], image, ticket.answer.read[k]);
    ticket.answer.scan_number = served.scan_number;
    ticket.result.emplace(std::move(ticket.answer));
  }
  served.queue.erase(served.queue.begin(), served.queue.begin() + static_cast<std::ptrdiff_t>(count));
  answered_.notify_all();
}

void Gateway::close() noexcept {
  const std::lock_guard lock{mutex_};
  closed_ = true;
  for (Cycle& cycle : cycles_) {
    for (const auto& ticket : cycle.queue) ticket->result = tl::unexpected{GatewayError::closed};
    cycle.queue.clear();
  }
  answered_.notify_all();
}

void Gateway::set_limits(const GatewayLimits& limits) noexcept {
  const std::lock_guard lock{mutex_};
  limits_ = limits;
  for (Cycle& cycle : cycles_) cycle.queue.reserve(limits_.queue_max);
}

std::uint64_t Gateway::refused_count() const noexcept {
  const std::lock_guard lock{mutex_};
  return refused_count_;
}

}  // namespace emulator_models::soft_plc
