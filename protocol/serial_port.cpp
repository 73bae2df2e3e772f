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
    case PortError::not_executed:
      return "the message was not executed, as nobody took it";
    case PortError::unanswered:
      return "the message was taken and not answered in time";
    case PortError::receiver_gone:
      return "the one that had taken the message ended, or was started anew, before it answered";
    case PortError::damaged:
      return "the answer was damaged, or too long";
  }
  return "unknown port error";
}

}  // namespace protocol
