// The port manager of a kernel that works with real serial lines: the name of a port is its device path.
#pragma once

#include <memory>
#include <string_view>

#include <tl/expected.hpp>

#include "protocol/port_manager.hpp"
#include "protocol/ports_by_name.hpp"
#include "protocol/posix_serial_port.hpp"

namespace protocol {

class PosixPortManager final : public PortManager {
 public:
  /// @param settings  of every port handed out
  explicit PosixPortManager(const LineSettings& settings = {});

  /// @param name  device path
  [[nodiscard]] tl::expected<std::shared_ptr<SerialPort>, PortError> port(std::string_view name) override;

 private:
  LineSettings settings_;
  PortsByName ports_;
};

}  // namespace protocol
