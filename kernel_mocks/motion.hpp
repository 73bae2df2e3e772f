// What a block moves, how far and for how long: interpretation without interpolation.
//
// Positions are in machine coordinates, mm and degrees, from zero at the program start. Work offsets (G54) and
// tool lengths (G43) are zero: the kernel has no tables of them. Velocity profiles are left out; a motion lasts its
// length divided by its rate.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include <tl/expected.hpp>

#include "kernel_mocks/g_codes.hpp"
#include "kernel_mocks/nc_error.hpp"
#include "kernel_mocks/nc_program.hpp"

namespace kernel_mocks {

inline constexpr std::string_view axis_letters = "XYZABCUVW";
inline constexpr std::size_t axis_count = 9;
inline constexpr std::size_t z_axis = 2;

struct AxisOptions {
  /// mm/min (degrees/min of A, B, C), above zero. The slowest axis decides; no feed is faster either.
  std::array<double, axis_count> rapid = {10'000, 10'000, 10'000, 10'000, 10'000,
                                          10'000, 10'000, 10'000, 10'000};
  struct Travel {
    double min;
    double max;
  };
  /// Machine coordinates; an axis without is endless.
  std::array<std::optional<Travel>, axis_count> travel{};
  /// Z from which on it stands at the tool change position: the top of its travel on a real machine.
  double tool_change_z = 0;
  /// Motion lasts so many percent of its time; 0: none at all, as in a dry run of the PLC program.
  unsigned time_percent = 100;
};

enum class MotionKind : std::uint8_t { rapid, feed, dwell };
inline constexpr std::size_t motion_kind_count = 3;

struct Motion {
  MotionKind kind = MotionKind::rapid;
  std::chrono::nanoseconds duration{0};
  /// Z in machine coordinates, after the motion.
  double z = 0;
};

/// Longest motion of one block.
inline constexpr std::chrono::hours motion_duration_max{24};

/// To be asked for each block in the order of the program.
class MotionPlanner {
 public:
  explicit MotionPlanner(const AxisOptions& options) : options_{options} {}

  /// @param block  as the parser lets it through
  /// @return       nothing when the block neither moves nor dwells
  [[nodiscard]] tl::expected<std::optional<Motion>, NcError> plan(const Block& block);

 private:
  using Position = std::array<double, axis_count>;
  using Planned = tl::expected<std::optional<Motion>, NcError>;

  void take_modes(const Block& block);
  [[nodiscard]] Position target_of(const Block& block, bool machine_coordinates) const;
  Planned set_offset(const Block& block, GTenths code);
  Planned to_reference(const Block& block);
  Planned feed_to(const Block& block, const Position& target, double length_mm);
  Planned along_arc(const Block& block, const Position& target);
  [[nodiscard]] std::optional<std::size_t> axis_beyond_travel(const Position& position) const;
  Planned arrive(const Block& block, const Position& target, MotionKind kind, double minutes);
  [[nodiscard]] double rapid_minutes(const Position& from, const Position& to) const;
  [[nodiscard]] double scaled(std::size_t axis, const Word& word) const;

  AxisOptions options_;
  Position position_{};
  Position offset_{};
  Position kept_offset_{};
  GTenths motion_ = 800;
  GTenths plane_ = 170;
  GTenths feed_mode_ = 940;
  bool absolute_ = true;
  bool absolute_centre_ = false;
  bool diameter_ = false;
  double mm_per_unit_ = 1;
  double feed_ = 0;
  double speed_ = 0;
};

/// Plans every block: a motion that this machine cannot carry out is refused before anything moves.
[[nodiscard]] tl::expected<void, NcError> check_motion(const Program& program, const AxisOptions& axes);

}  // namespace kernel_mocks
