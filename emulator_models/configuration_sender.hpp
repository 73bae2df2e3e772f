// The other end of a transfer: sends a configuration to the PLC behind a port, as an engineering tool does.
//
// What is not answered, or damaged, is sent again from the first message on, a few times: a transfer that is begun anew
// drops the one before, and a configuration that is taken twice is the same configuration.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/configuration_frames.hpp"
#include "protocol/serial_port.hpp"

namespace emulator_models {

class ConfigurationSender {
 public:
  static constexpr int tries_max = 3;

  /// For begin and chunks: a message of 521 characters at 9600 bit/s takes half a second. A commit waits longer, as the
  /// PLC compiles programs before it answers.
  struct Patience {
    std::chrono::nanoseconds message = std::chrono::seconds{2};
    std::chrono::nanoseconds commit = std::chrono::seconds{15};
  };

  struct Failure {
    bool is_refusal = false;  ///< the PLC has judged the text; otherwise the transfer has failed
    std::string reason;
  };

  /// @param port  open; must outlive the sender, which sets its time-outs
  explicit ConfigurationSender(protocol::SerialPort& port) noexcept : ConfigurationSender{port, Patience{}} {}
  ConfigurationSender(protocol::SerialPort& port, Patience patience) noexcept
      : port_{port}, patience_{patience} {}

  /// @return nothing: the PLC has taken it; or why not. Of a text with a mistake the reason begins with
  ///         ":line:column: ", in front of which belongs the name of the file
  [[nodiscard]] tl::expected<void, Failure> send(std::string_view text);

 private:
  [[nodiscard]] tl::expected<void, Failure> try_once(std::string_view text);
  [[nodiscard]] tl::expected<TransferAnswer, Failure> exchange(const TransferRequest& request);
  [[nodiscard]] std::string whole_reason(std::uint32_t sum, const TransferAnswer& first);

  protocol::SerialPort& port_;
  const Patience patience_;
};

}  // namespace emulator_models
