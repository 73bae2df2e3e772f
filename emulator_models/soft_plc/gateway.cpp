#include "emulator_models/soft_plc/gateway.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "protocol/deadline.hpp"

namespace emulator_models::soft_plc {

class Gateway::Ticket {
 public:
  explicit Ticket(GatewayRequest asked) : request{std::move(asked)} {}

  const GatewayRequest request;
  std::optional<Result> result;  ///< guarded by the gateway's mutex
};

namespace {

std::span<std::byte> area_of(const CycleImage& image, Area area) noexcept {
  if (area == Area::inputs) return image.inputs;
  return area == Area::outputs ? image.outputs : image.memory;
}

GatewayAnswer carry_out(const GatewayRequest& request, const CycleImage& image, std::uint64_t scan_number) {
  GatewayAnswer answer{scan_number, {}};
  for (const GatewayItem& item : request.items) {
    const auto at = area_of(image, item.area).begin() + static_cast<std::ptrdiff_t>(item.section.first);
    auto& read = answer.read.emplace_back();
    if (item.written.empty()) {
      read.assign(at, at + static_cast<std::ptrdiff_t>(item.section.bytes));
    } else {
      std::ranges::copy(item.written, at);
    }
  }
  return answer;
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
    for (const Area area : {Area::inputs, Area::outputs, Area::memory})
      cycle.bytes[static_cast<std::size_t>(area)] = area_of(image, area).size();
  }
}

tl::expected<void, GatewayError> Gateway::check_item(const GatewayItem& item,
                                                     std::size_t cycle) const noexcept {
  const Section section{item.section.first, item.written.empty() ? item.section.bytes : item.written.size()};
  const std::size_t area_bytes = cycles_[cycle].bytes[static_cast<std::size_t>(item.area)];
  if (section.bytes == 0 || !section.fits(area_bytes)) return tl::unexpected{GatewayError::out_of_range};
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
  if (!keep_waiting) std::erase(cycles_[ticket->request.cycle].queue, ticket);
  return tl::unexpected{GatewayError::timed_out};
}

Gateway::Result Gateway::exchange(GatewayRequest request, std::chrono::nanoseconds timeout) {
  const auto deadline = protocol::deadline_after(timeout);
  const auto ticket = submit(std::move(request));
  if (!ticket) return tl::unexpected{ticket.error()};
  {
    std::unique_lock lock{mutex_};
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
  for (std::size_t i = 0; i < limits_.requests_per_scan_max && !served.queue.empty(); ++i) {
    Ticket& ticket = *served.queue.front();
    ticket.result = carry_out(ticket.request, image, served.scan_number);
    served.queue.pop_front();
    answered_.notify_all();
  }
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
}

std::uint64_t Gateway::refused_count() const noexcept {
  const std::lock_guard lock{mutex_};
  return refused_count_;
}

}  // namespace emulator_models::soft_plc
