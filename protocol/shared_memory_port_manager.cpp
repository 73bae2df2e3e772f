#include "protocol/shared_memory_port_manager.hpp"

#include <utility>

#include "protocol/shared_memory_port.hpp"

namespace protocol {

SharedMemoryPortManager::SharedMemoryPortManager(const HandoffOptions& options, ExchangeObserver* observer)
    : options_(options), observer_(observer) {}

tl::expected<std::shared_ptr<SerialPort>, PortError> SharedMemoryPortManager::port(std::string_view name) {
  return ports_.find_or_make(name, [this](std::string segment_name) {
    return std::visit(
        [&](const auto& options) {
          return std::make_shared<SharedMemoryPort>(std::move(segment_name), options, observer_);
        },
        options_);
  });
}

}  // namespace protocol
