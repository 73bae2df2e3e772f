#include "emulator_models/served_segment.hpp"

#include <variant>

#include <fmt/format.h>

#include "protocol/hardened/slave.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"

namespace emulator_models {
namespace {

using protocol::Handoff;
using protocol::SharedMemoryWrapper;
namespace hardened = protocol::hardened;

std::unique_ptr<protocol::ExchangeSlave> make_slave(const std::string& name,
                                                    const protocol::HandoffOptions& options) {
  if (const auto* const paper = std::get_if<protocol::PaperOptions>(&options))
    return std::make_unique<protocol::SlaveSharedMemoryWrapper>(name, *paper);
  return std::make_unique<hardened::Slave>(name, std::get<hardened::Options>(options));
}

}  // namespace

ServedSegment::ServedSegment(const std::string& name, const protocol::HandoffOptions& options)
    : name_{name},
      options_{options},
      role_{name, protocol::Role::emulator},
      kernel_role_{name, protocol::Role::kernel},
      slave_{make_slave(name, options)} {}

ServedSegment::~ServedSegment() {
  if (!role_.is_held()) return;
  slave_->close();
  if (protocol::kind_of(options_) == Handoff::hardened) {
    static_cast<void>(hardened::remove_segment(name_));
  } else {
    SharedMemoryWrapper::remove(name_);
  }
  role_.release();
}

tl::expected<std::string, std::string> ServedSegment::open() {
  if (const auto locked = role_.try_lock(); !locked) {
    if (locked.error() == protocol::RoleLockError::held_by_other)
      return tl::unexpected(
          fmt::format("segment '{}': another emulator serves it. Stop that one, or choose "
                      "another name",
                      name_));
    return tl::unexpected(fmt::format("segment '{}': {}", name_, to_string(locked.error())));
  }
  std::string told;
  if (const auto found = protocol::handoff_of_segment(name_)) {
    if (remove_left_over(*found)) {
      told = fmt::format("removed what a killed process left of segment '{}'", name_);
    } else if (*found == protocol::kind_of(options_)) {
      told = fmt::format("segment '{}' is there and a kernel is attached: joined{}", name_,
                         *found == Handoff::paper ? " as it is" : "");
    } else {
      role_.release();  // what is there is none of ours
      return tl::unexpected(
          fmt::format("segment '{0}': a kernel with --protocol {1} is attached to it. Stop that kernel, give "
                      "--protocol {1}, or choose another name",
                      name_, protocol::name_of(*found)));
    }
  }
  if (const auto opened = slave_->open(); !opened)
    return tl::unexpected(fmt::format("segment '{}': {}", name_, to_string(opened.error())));
  return told;
}

bool ServedSegment::remove_left_over(Handoff found) noexcept {
  if (kernel_role_.is_held_by_other()) return false;
  if (found == Handoff::hardened) return hardened::remove_segment(name_).has_value();
  SharedMemoryWrapper::remove(name_);
  return true;
}

std::string ServedSegment::at_the_end() const {
  if (!kernel_role_.is_held_by_other()) return {};
  return protocol::kind_of(options_) == Handoff::hardened
             ? "a kernel is still attached; the segment stays until it ends"
             : "a kernel is still attached; it has to be started again to find the next emulator";
}

}  // namespace emulator_models
