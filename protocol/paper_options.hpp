// The questions that the published design leaves open, as run-time options.
//
// Source: N. V. Kozak, R. A. Abdullaev, "Debugging module for the mechanisms of the logic task in the CNC
// kernel" (MSTU "Stankin"). K1 to K11 number the open questions as protocol/README.md does; the first value
// of each enumeration is the default. K11 (how many kernel threads, kernels and emulators share the objects)
// is not an option: it is a matter of how many wrappers are made. K12 goes
// beyond the text, which says nothing of memory orders: its second value cures what follows (hazard H17).
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace protocol {

struct PaperOptions {
  /// K1: does reading wait for the answer?
  enum class ReadWait : std::uint8_t { poll, immediately };
  /// K2: one value, or two halves (bits 0-15 request, 16-31 response) changed by load, modify, store.
  enum class StateCoding : std::uint8_t { enumeration, halves };
  /// K3: what "the semaphore is blocked" means: the next wait consumes the post, or the count is forced to 0.
  enum class SemaphoreAfterAnswer : std::uint8_t { wait, reset };
  /// K4: maximum count of the semaphore. With `one` a second release fails.
  enum class SemaphoreMaximum : std::uint8_t { large, one };
  /// K5: who fills a fresh segment with zeros.
  enum class Initialiser : std::uint8_t { creator, slave, creator_and_slave, nobody };
  /// K6: what of an area is written (and read) first.
  enum class AreaOrder : std::uint8_t { length_first, bytes_first };
  /// K7: who takes the state back from "response".
  enum class StateTakenBack : std::uint8_t { by_master, by_nobody };
  /// K8: what follows when no answer has come within read_timeout.
  enum class OnTimeOut : std::uint8_t { give_up, wait_for_ever, send_again };
  /// K9: what a reader does with the length it finds in an area.
  enum class LengthCheck : std::uint8_t { none, check_and_load_again, load_once };
  /// K10: count of the semaphore when an instance opens it.
  enum class SemaphoreStart : std::uint8_t { zero, one, left_over };
  /// K12: what makes the master who sees "response" see the bytes of it: nothing, or the state word.
  enum class AnswerOrder : std::uint8_t { as_published, release_and_acquire };

  ReadWait read_wait = ReadWait::poll;
  StateCoding state_coding = StateCoding::enumeration;
  SemaphoreAfterAnswer semaphore_after_answer = SemaphoreAfterAnswer::wait;
  SemaphoreMaximum semaphore_maximum = SemaphoreMaximum::large;
  Initialiser initialiser = Initialiser::creator;
  AreaOrder area_order = AreaOrder::length_first;
  StateTakenBack state_taken_back = StateTakenBack::by_master;
  OnTimeOut on_time_out = OnTimeOut::give_up;
  LengthCheck length_check = LengthCheck::none;
  SemaphoreStart semaphore_start = SemaphoreStart::zero;
  AnswerOrder answer_order = AnswerOrder::as_published;

  /// K8: time from the beginning of the read to the time-out. A serial read of the published kind waits tens
  /// of ms.
  std::chrono::nanoseconds read_timeout = std::chrono::milliseconds{100};
  /// K8 = send_again: how often the same request is sent again before the master gives up after all.
  unsigned send_again_count_max = 2;
  /// K1 = poll: pause between two looks at the state word.
  std::chrono::nanoseconds poll_interval = std::chrono::milliseconds{1};

  /// Capacity of the contents of each area. The design gives none; the longest FX frame has 521 bytes.
  std::uint32_t request_bytes_max = 576;
  std::uint32_t response_bytes_max = 576;
};

}  // namespace protocol
