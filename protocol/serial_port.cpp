#include "protocol/serial_port.hpp"

namespace protocol {

std::string_view to_string(PortError error) noexcept {
  switch (error) {
    case PortError::not_open:
      return "the port is not open";
    case PortError::cannot_open:
      return "the port cannot be opened";
    case PortError::already_in_use:
      return "the port is in use by somebody else";
    case PortError::message_too_long:
      return "the message is longer than the port can carry";
    case PortError::refused:
      return "the port did not accept the message";
    case PortError::line_lost:
      return "the line was lost";
  }
  return "unknown port error";
}

}  // namespace protocol
