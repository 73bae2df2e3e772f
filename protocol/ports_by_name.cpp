#include "protocol/ports_by_name.hpp"

namespace protocol {

std::shared_ptr<SerialPort> PortsByName::find_or_make(std::string_view name, const Make& make) {
  const std::lock_guard lock(mutex_);
  const auto found = ports_.find(name);
  if (found != ports_.end()) return found->second;
  std::string key(name);
  return ports_.emplace(key, make(key)).first->second;
}

}  // namespace protocol
