// A PLC for the tests of the logic task: answers the FX protocol from a small memory, and runs a scan, which
// the test supplies, after every request.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "protocol/fx/address_map.hpp"
#include "protocol/fx/frame.hpp"
#include "protocol/serial_port.hpp"

namespace kernel_mocks {

class ScriptedPlc final : public protocol::SerialPort {
 public:
  using Device = protocol::fx::Device;

  /// Ready for a program start, and obedient.
  ScriptedPlc();

  /// Runs after every request.
  std::function<void(ScriptedPlc&)> scan;
  /// Raises FIN when a strobe is on, and takes it back when none is.
  static void obey(ScriptedPlc& plc);

  /// Requests that changed something, in their order: "D100 = 3 500 0", "M96 byte B0", "M104 on".
  std::vector<std::string> log;
  /// When each of them came.
  std::vector<std::chrono::steady_clock::time_point> times;
  /// Status bytes that were read so far.
  unsigned polls = 0;
  /// From this request on there is no answer; 0 = never.
  std::size_t silent_from_request = 0;

  [[nodiscard]] bool bit(std::uint16_t m) const noexcept;
  void set_bit(std::uint16_t m, bool on) noexcept;
  [[nodiscard]] std::uint16_t word(std::uint16_t d) const noexcept;
  void set_word(std::uint16_t d, std::uint16_t value) noexcept;
  /// Whether MF, SF or TF is on.
  [[nodiscard]] bool any_strobe() const noexcept;
  void clear_memory() noexcept { memory_ = {}; }

  tl::expected<void, protocol::PortError> open() noexcept override { return {}; }
  void close() noexcept override {}
  bool is_open() const noexcept override { return true; }
  tl::expected<std::size_t, protocol::PortError> write(std::span<const std::byte> bytes) noexcept override;
  tl::expected<std::size_t, protocol::PortError> read(std::span<std::byte> into) noexcept override;
  void set_timeouts(const protocol::PortTimeouts&) noexcept override {}
  void purge() noexcept override { answer_.clear(); }

 private:
  void execute(const protocol::fx::Request& request);
  void note(std::string change);

  std::array<std::byte, 0x2000> memory_{};
  std::vector<std::byte> answer_;
  std::size_t requests_ = 0;
};

}  // namespace kernel_mocks
