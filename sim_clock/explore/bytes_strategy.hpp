// The choices of an execution from a string of bytes, so that a fuzzing engine that changes bytes changes choices.
//
// The bytes are records, each a deviation from the default:
//
//   byte  0     what is decided (Kind); what is no kind counts as one: its remainder
//   byte  1, 2  so many decisions of this kind after the one before are made by the default, low byte first
//   byte  3, 4  the value: which of the answers that are not the default, its remainder by how many there are
//
// A record counts its own kind of decision only, and from the record of that kind before it: one that is put in, taken away
// or changed leaves the places of the others as they are, as far as the execution does. Every string is valid: a record at the
// end that is cut short goes on with zeros, and records whose decision never comes are passed over. Behind the last record
// all is default: the empty string is the default schedule. Executions end as they do under any strategy, by the world's
// fair tail.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

class BytesStrategy final : public Strategy {
 public:
  /// `fault` and what follows are the kinds of faults: kind_of(); the last is the age of a store: age_kind.
  enum class Kind : std::uint8_t { task, slow_machine, slow_task, answer, fault };

  static constexpr std::size_t record_bytes = 5;
  static constexpr std::size_t age_kind = static_cast<std::size_t>(Kind::fault) + fault_kinds_count;
  static constexpr std::size_t kinds_count = age_kind + 1;
  /// Of a slow moment. Value 0 is until the next timer where one is armed, those above are remainders.
  static constexpr std::array<SimTime, 7> durations{
      std::chrono::microseconds{10}, std::chrono::milliseconds{1},  std::chrono::milliseconds{5},
      std::chrono::milliseconds{20}, std::chrono::milliseconds{60}, std::chrono::milliseconds{110},
      std::chrono::milliseconds{250}};

  struct Record {
    std::uint8_t kind = 0;  ///< below kinds_count
    std::uint16_t skipped_count = 0;
    std::uint16_t value = 0;

    bool operator==(const Record&) const = default;
  };

  [[nodiscard]] static constexpr std::uint8_t kind_of(FaultKind fault) noexcept {
    return static_cast<std::uint8_t>(static_cast<std::size_t>(Kind::fault) + static_cast<std::size_t>(fault));
  }
  /// The first record of `bytes`, which are not empty.
  [[nodiscard]] static Record read(std::span<const std::byte> bytes) noexcept;
  static void write(const Record& record, std::span<std::byte, record_bytes> into) noexcept;
  /// The bytes cut into records, for InputFormat.
  [[nodiscard]] static std::vector<std::string_view> split(std::string_view bytes);

  /// From the next execution on.
  /// @param bytes  must outlive it
  void set_bytes(std::span<const std::byte> bytes) noexcept { bytes_ = bytes; }

  /// By kind: how many decisions an execution had at most, of all that are over. A record beyond them decides nothing.
  using DecisionCounts = std::array<std::uint32_t, kinds_count>;
  [[nodiscard]] const DecisionCounts& most_decisions() const noexcept { return most_decisions_; }

  [[nodiscard]] std::string_view name() const noexcept override { return "bytes"; }
  /// The seed does not matter.
  void begin_execution(std::uint64_t seed) noexcept override;
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override;
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override;

 private:
  /// The next record of a kind.
  struct Cursor {
    std::size_t next = 0;                // where in bytes_ to look for the one after it
    std::uint32_t decisions_before = 0;  // until it is due; `none`: there is no more
    std::uint16_t value = 0;
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  void advance(std::size_t kind) noexcept;
  /// One decision of this kind. @return whether it is the cursor's: take() then
  [[nodiscard]] bool is_due(std::size_t kind) noexcept {
    ++decisions_[kind];
    Cursor& cursor = cursors_[kind];
    if (cursor.decisions_before == none) return false;
    return cursor.decisions_before-- == 0;
  }
  /// @return the value of the record that is due; the cursor moves on
  std::uint16_t take(std::size_t kind) noexcept;

  std::span<const std::byte> bytes_;
  std::array<Cursor, kinds_count> cursors_{};
  DecisionCounts decisions_{};  // of this execution
  DecisionCounts most_decisions_{};
};

}  // namespace ltsim
