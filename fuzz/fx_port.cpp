// The programming port byte by byte, as a serial line brings them: the receiver, its time-out, and the emulator behind.
//
// Byte FFH is a silence longer than the character time-out; any other byte comes as it is, those that no line of 7 bits
// brings as well. After each byte the answer, and whether a frame is under way, are those of a second receiver that is
// made here of text, with the reference PLC behind it.

#include <string>
#include <utility>

#include "emulator_models/fx_plc_emulator.hpp"
#include "fuzz/fx_frame_mutator.hpp"
#include "fuzz/fx_reference_plc.hpp"
#include "protocol/fx/frame.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using protocol::fx::FrameReceiver;
using protocol::fx::Model;

constexpr std::byte silence{0xFF};

/// What is done with each byte of the line (pty_server.cpp).
class Port {
 public:
  protocol::fx::FrameBytes receive(std::byte byte) {
    if (byte == silence) {
      receiver_.reset();
      return {};
    }
    const FrameReceiver::Event event = receiver_.receive(byte);
    if (event == FrameReceiver::Event::enq_received) return plc_.process({&byte, 1});
    if (event == FrameReceiver::Event::frame) return plc_.process(receiver_.frame());
    return {};
  }
  [[nodiscard]] const FrameReceiver& receiver() const { return receiver_; }

 private:
  FrameReceiver receiver_;
  emulator_models::FxPlcEmulator plc_{Model::fx3u};
};

class ReferencePort {
 public:
  std::string receive(char byte) {
    constexpr std::size_t frame_longest = 521;
    constexpr char ack = 0x06;
    constexpr char nak = 0x15;
    if (byte == static_cast<char>(silence)) {
      begun_.clear();
    } else if (byte == 0x05) {
      begun_.clear();
      return plc_.answer("\x05");
    } else if (byte == 0x02) {
      begun_ = byte;
    } else if (begun_.empty()) {
      if (byte != ack && byte != nak) ++skipped_;
    } else if (begun_.size() == frame_longest) {
      begun_.clear();
    } else {
      begun_ += byte;
      const std::size_t end = begun_.find('\x03');
      if (end != std::string::npos && begun_.size() == end + 3) return plc_.answer(std::exchange(begun_, {}));
    }
    return {};
  }
  [[nodiscard]] bool is_in_frame() const { return !begun_.empty(); }
  [[nodiscard]] std::size_t skipped() const { return skipped_; }

 private:
  std::string begun_;
  std::size_t skipped_ = 0;
  fuzz::ReferencePlc plc_{Model::fx3u};
};

}  // namespace

FUZZ_TARGET("fx-port", {.split = fuzz::frames_as_records, .mutate = fuzz::mutate_stream},
            "bytes and silences at the programming port of an FX PLC, against a second receiver and PLC") {
  Port port;
  ReferencePort reference;
  for (const std::byte byte : input) {
    const protocol::fx::FrameBytes answer = port.receive(byte);
    const auto bytes = protocol::fx::as_span(answer);
    const std::string_view text{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    ltsim::expect(text == reference.receive(static_cast<char>(byte)), "a byte is answered as the rules say");
    ltsim::expect(port.receiver().in_frame() == reference.is_in_frame(), "a frame is under way from STX on");
  }
  ltsim::expect(port.receiver().skipped_bytes_count() == reference.skipped(),
                "each byte between frames counts");
}
