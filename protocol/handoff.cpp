#include "protocol/handoff.hpp"

#include "protocol/hardened/endpoint.hpp"
#include "protocol/shared_memory_wrapper.hpp"

namespace protocol {

std::string_view name_of(Handoff handoff) noexcept {
  return handoff == Handoff::hardened ? "hardened" : "paper";
}

Handoff kind_of(const HandoffOptions& options) noexcept {
  return std::holds_alternative<hardened::Options>(options) ? Handoff::hardened : Handoff::paper;
}

std::optional<Handoff> handoff_of_segment(const std::string& segment_name) noexcept {
  if (hardened::segment_exists(segment_name)) return Handoff::hardened;
  if (SharedMemoryWrapper::exists(segment_name)) return Handoff::paper;
  return std::nullopt;
}

void remove_if_unused(const std::string& segment_name, const HandoffOptions& options) noexcept {
  if (const auto* const hardened = std::get_if<hardened::Options>(&options))
    static_cast<void>(hardened::remove_segment(segment_name, *hardened));
}

}  // namespace protocol
