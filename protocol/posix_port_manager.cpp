#include "protocol/posix_port_manager.hpp"

#include <utility>

namespace protocol {

PosixPortManager::PosixPortManager(const LineSettings& settings) : settings_(settings) {}

tl::expected<std::shared_ptr<SerialPort>, PortError> PosixPortManager::port(std::string_view name) {
  return ports_.find_or_make(name, [this](std::string device_path) {
    return std::make_shared<PosixSerialPort>(std::move(device_path), settings_);
  });
}

}  // namespace protocol
