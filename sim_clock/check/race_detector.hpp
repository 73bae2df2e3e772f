// Data races on shared segments, by happens-before: two accesses to one byte, one of them a write and one of
// them plain, that nothing orders. Whoever makes them, through whatever mapping: a place is a segment and a
// byte.
//
// For each eight bytes the accesses are kept that a later one could still race with. One is forgotten when
// another that comes after it stands for it: at least as many bytes, a write if it was a write, plain if it
// was plain. So the first race of an execution is never missed and nothing that is ordered is ever reported
// (the idea of FastTrack, Flanagan and Freund, PLDI 2009, with the accesses kept in a list).
//
// Pooled; a new execution costs nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim_clock/check/happens_before.hpp"

namespace ltsim {

/// A byte of shared memory: the segment's number above 24 bits of offset; behind those, of a whole program, see ProgramMemory.
using SharedPlace = std::uint32_t;
/// Places in segments are less.
inline constexpr std::size_t segment_places_count = std::size_t{1} << 27U;

struct SharedAccess {
  TaskId task = 0;
  SharedPlace place = 0;
  std::uint8_t bytes = 0;  ///< 1 to 16
  bool writes = false;
  bool plain = false;      ///< not atomic
  std::uint32_t site = 0;  ///< as in Operation
  Ticks ticks = 0;         ///< of the task when it was made; 0: now
};

struct Race {
  struct Side {
    TaskId task = 0;
    bool writes = false;
    bool plain = false;
    std::uint32_t site = 0;
  };
  SharedPlace place = 0;   ///< the first byte that both access
  std::uint8_t bytes = 0;  ///< that both access, of the eight that hold the first
  Side one;                ///< writes; of two writers that with the lower number
  Side other;
};

class RaceDetector {
 public:
  /// Who wrote last to the eight bytes around a place.
  struct LastWrite {
    static constexpr TaskId nobody = 0xffff;
    TaskId task = nobody;
    std::uint32_t site = 0;
  };

  /// @param places_count  a multiple of 8: places are less than that
  RaceDetector(const HappensBefore& order, std::size_t places_count);
  ~RaceDetector();
  RaceDetector(const RaceDetector&) = delete;
  RaceDetector& operator=(const RaceDetector&) = delete;
  void reset() noexcept;

  /// @return who wrote last before this access, where it begins
  LastWrite access(const SharedAccess& access);

  /// Whether another task has accessed, in this execution, one of the bytes that `access` is about to, one of the two writes, and their
  /// order can be another one in another execution: both are atomic, and who made and joined whom does not order them; or it is a
  /// race. What locks order is not meant: there the order of the locks is what can be another one.
  [[nodiscard]] bool is_contended(const SharedAccess& access) const noexcept;

  /// The first race of this execution.
  [[nodiscard]] const std::optional<Race>& race() const noexcept { return race_; }

 private:
  static constexpr std::uint8_t write_flag = 1;
  static constexpr std::uint8_t plain_flag = 2;
  static constexpr std::uint8_t racing_flags =
      write_flag | plain_flag;  // what two accesses must have between them
  static constexpr std::uint32_t none = 0;

  /// An access that a later one may race with.
  struct Cell {
    std::uint32_t next;
    Ticks ticks;  // of its task, when it was made
    std::uint32_t site;
    std::uint8_t task;
    std::uint8_t bytes_mask;
    std::uint8_t flags;
  };
  /// Eight bytes of shared memory.
  struct Granule {
    std::uint32_t generation;  // of the execution that filled it
    std::uint32_t first;       // cell
    std::uint32_t write_site;
    TaskId write_task;
  };

  void access_granule(std::size_t index, Granule& granule, Cell access);
  void record(std::size_t index, const Cell& one, const Cell& other) noexcept;
  [[nodiscard]] std::uint32_t take_cell();

  const HappensBefore& order_;
  std::size_t granules_bytes_;
  Granule* granules_;        // reserved for all places; memory comes with use
  std::vector<Cell> cells_;  // the first is never used
  std::uint32_t cells_count_ = 1;
  std::uint32_t free_cell_ = none;
  std::uint32_t generation_ = 0;
  std::optional<Race> race_;
};

}  // namespace ltsim
