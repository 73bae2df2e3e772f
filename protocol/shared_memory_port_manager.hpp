// The port manager of a kernel that works with a PLC emulator: every port is a SharedMemoryPort, and the name
// of a port is the name of its segment.
#pragma once

#include <memory>
#include <string_view>

#include <tl/expected.hpp>

#include "protocol/exchange_observer.hpp"
#include "protocol/handoff.hpp"
#include "protocol/port_manager.hpp"
#include "protocol/ports_by_name.hpp"

namespace protocol {

class SharedMemoryPortManager final : public PortManager {
 public:
  /// @param observer  told of the exchanges of all ports; must outlive the manager and its ports
  explicit SharedMemoryPortManager(const HandoffOptions& options, ExchangeObserver* observer = nullptr);

  /// @param name  of the segment
  [[nodiscard]] tl::expected<std::shared_ptr<SerialPort>, PortError> port(std::string_view name) override;

 private:
  HandoffOptions options_;
  ExchangeObserver* observer_;
  PortsByName ports_;
};

}  // namespace protocol
