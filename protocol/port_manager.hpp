// Hands out the ports of the machine. The kernel asks its port manager for a port by name and gets a
// SerialPort; which kind of port that is, is the manager's business (the published design's PortManager).
#pragma once

#include <memory>
#include <string_view>

#include <tl/expected.hpp>

#include "protocol/serial_port.hpp"

namespace protocol {

class PortManager {
 public:
  virtual ~PortManager() = default;

  /// The port called `name`, not opened yet. A name asked for twice gives the same port: there is one line.
  /// @param name  what the manager's kind of port calls it: a device path, a segment name
  [[nodiscard]] virtual tl::expected<std::shared_ptr<SerialPort>, PortError> port(std::string_view name) = 0;
};

}  // namespace protocol
