// Serves a pseudo-terminal as the PLC's programming port: the frames byte by byte, as a serial line brings
// them.
//
// The line is raw 8N1 and takes no time for a character: Linux forces a pseudo-terminal to 8 bits without
// parity, so the port's 7E1 at 9600 cannot be had here. A frame that stops in the middle is dropped after
// the character time-out; so is one that is followed by STX or ENQ. Answers that nobody fetches are dropped
// when the terminal is full.
#pragma once

#include <chrono>
#include <string>

#include "emulator_models/i_plc_emulator.hpp"
#include "protocol/fx/frame.hpp"

namespace emulator_models {

class PtyServer {
 public:
  /// Two hundred characters at 9600 bit/s: no computer pauses as long within a frame, and a person who types
  /// one does not come back to a port that still waits.
  static constexpr std::chrono::milliseconds character_timeout{200};

  /// @param plc  must outlive the server
  explicit PtyServer(IPlcEmulator& plc) noexcept;
  PtyServer(const PtyServer&) = delete;
  PtyServer& operator=(const PtyServer&) = delete;
  ~PtyServer();

  /// Makes the pseudo-terminal.
  /// @return whether the system gave one; errno tells why not
  [[nodiscard]] bool open() noexcept;
  /// What the other program opens: "/dev/pts/3".
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  /// Serves until request_stop(), or until the system takes the terminal away. One thread; needs open().
  void run() noexcept;
  /// From any thread or signal handler.
  void request_stop() noexcept;

 private:
  void receive(std::byte byte) noexcept;
  void answer(std::span<const std::byte> request) noexcept;

  IPlcEmulator& plc_;
  protocol::fx::FrameReceiver receiver_;
  std::string path_;
  int master_ = -1;
  /// Kept open so that the terminal survives when a client closes it and the next one comes.
  int slave_ = -1;
  int stop_event_ = -1;
};

}  // namespace emulator_models
