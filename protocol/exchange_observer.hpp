// What happens in one exchange, told to whoever wants to know.
//
// The wrappers report each event of an exchange at the step at which it takes effect. They do not know who
// listens: a test that keeps ghost state, a console that shows the traffic, nobody. An observer must not
// touch the exchange. Events of the master are reported by the master's process, those of the slave by the
// slave's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace protocol {

/// How a request ended for the kernel.
enum class ExchangeOutcome : std::uint8_t {
  ok,            ///< an answer was delivered
  rejected,      ///< the slave answered that it will not execute it
  not_executed,  ///< it is certain that the slave has not executed it and never will
  unknown,       ///< given up: it may have been executed, or may yet be
};

[[nodiscard]] inline std::string_view to_string(ExchangeOutcome outcome) noexcept {
  switch (outcome) {
    case ExchangeOutcome::ok:
      return "ok";
    case ExchangeOutcome::rejected:
      return "rejected";
    case ExchangeOutcome::not_executed:
      return "not executed";
    case ExchangeOutcome::unknown:
      return "unknown";
  }
  return "";
}

class ExchangeObserver {
 public:
  virtual ~ExchangeObserver() = default;

  /// SUBMIT: the kernel handed this request to the master wrapper; nothing has been written yet.
  virtual void submitted(std::span<const std::byte> /*request*/) noexcept {}
  /// FILL, hardened: the master turns to the request area.
  virtual void filling() noexcept {}
  /// PUBLISH: the state word says that there is a request.
  virtual void published() noexcept {}
  /// TAKE: the slave has been woken and turns to the request area.
  virtual void taken() noexcept {}
  /// EXEC: the slave hands these bytes to the emulator.
  virtual void executed(std::span<const std::byte> /*request*/) noexcept {}
  /// ANSWER: the slave is about to set the state word to "response"; these bytes are the answer.
  virtual void answered(std::span<const std::byte> /*response*/) noexcept {}
  /// ANNOUNCE: the state word says that there is an answer.
  virtual void announced() noexcept {}
  /// ACCEPT: the master turns to the response area, having seen the state word say so (K1 = immediately:
  /// without having looked).
  virtual void accepted() noexcept {}
  /// DELIVER: the master returns these bytes to the kernel.
  virtual void delivered(std::span<const std::byte> /*response*/) noexcept {}
  /// OUTCOME: the request submitted last has ended for the kernel.
  virtual void ended(ExchangeOutcome /*outcome*/) noexcept {}

  /// ATTACH, hardened: who reports it plays his role from here on, and the state word says so.
  virtual void attached() noexcept {}
  /// DETACH, hardened: who reports it is about to give his role back.
  virtual void detaching() noexcept {}
  /// MOVE, hardened: who reports it has just put one state word in the place of another.
  virtual void moved(std::uint32_t /*from*/, std::uint32_t /*to*/) noexcept {}

 protected:
  ExchangeObserver() = default;
  ExchangeObserver(const ExchangeObserver&) = default;
  ExchangeObserver& operator=(const ExchangeObserver&) = default;
};

/// Nobody who listens.
[[nodiscard]] inline ExchangeObserver& silent_observer() noexcept {
  struct SilentObserver final : ExchangeObserver {};
  static SilentObserver observer;
  return observer;
}

}  // namespace protocol
