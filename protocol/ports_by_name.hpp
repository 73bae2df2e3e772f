// One port for each name: what every port manager keeps.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "protocol/serial_port.hpp"

namespace protocol {

class PortsByName {
 public:
  using Make = std::function<std::shared_ptr<SerialPort>(std::string name)>;

  /// @param make  called when the name is asked for the first time
  std::shared_ptr<SerialPort> find_or_make(std::string_view name, const Make& make);

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<SerialPort>, std::less<>> ports_;
};

}  // namespace protocol
