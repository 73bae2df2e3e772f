#include "emulator_models/served_segment.hpp"

#include <fmt/format.h>

namespace emulator_models {

using protocol::SharedMemoryWrapper;

ServedSegment::ServedSegment(const std::string& name, const protocol::PaperOptions& paper)
    : name_{name},
      role_{name, protocol::Role::emulator},
      kernel_role_{name, protocol::Role::kernel},
      slave_{name, paper} {}

ServedSegment::~ServedSegment() {
  if (!role_.is_held()) return;
  slave_.close();
  SharedMemoryWrapper::remove(name_);
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
  std::string found;
  if (SharedMemoryWrapper::exists(name_)) {
    if (kernel_is_attached()) {
      found = fmt::format("segment '{}' is there and a kernel is attached: joined as it is", name_);
    } else {
      SharedMemoryWrapper::remove(name_);
      found = fmt::format("removed what a killed process left of segment '{}'", name_);
    }
  }
  if (const auto opened = slave_.open(); !opened)
    return tl::unexpected(fmt::format("segment '{}': {}", name_, to_string(opened.error())));
  return found;
}

bool ServedSegment::kernel_is_attached() const noexcept { return kernel_role_.is_held_by_other(); }

}  // namespace emulator_models
