// Tool magazine with 12 pockets, and the arm that exchanges the tools of pocket and spindle.
//
// The pocket comes down, the arm grips both tools, the spindle lets go, the arm exchanges, the spindle clamps,
// the arm goes home. Without power everything stays where it is, only the springs clamp the tool.
//
// Invariants
//   I1  an exchange needs the arm at the tools, the pocket down, the tool unclamped: else the arm jams, which is
//       a motor overload until its order is off.
//   I2  no tool is lost: the 13 places always hold the numbers 0 (none) to 12.
#pragma once

#include <array>
#include <cstdint>

#include "emulator_models/plants/plant_motion.hpp"
#include "emulator_models/plants/terminals.hpp"

namespace emulator_models::machine_tool {

class ToolChanger {
 public:
  static constexpr std::size_t pockets_count = 12;
  static constexpr std::chrono::milliseconds pocket_time{800};
  /// The pulse is on so long before and after the middle of a pocket.
  static constexpr std::chrono::milliseconds pulse_half{100};
  static constexpr std::chrono::milliseconds pocket_down_time{600};
  static constexpr std::chrono::milliseconds arm_grip_time{500};
  static constexpr std::chrono::milliseconds arm_exchange_time{1000};
  static constexpr std::chrono::milliseconds clamp_time{300};

  ToolChanger() noexcept;

  void advance(Terminals& terminals, bool powered, SteadyTime now) noexcept;

  void set_magazine_overload(bool on) noexcept { magazine_overload_ = on; }
  void set_magazine_stuck(bool on) noexcept { magazine_stuck_ = on; }
  void set_pulse_lost(bool on) noexcept { pulse_lost_ = on; }
  void set_pocket_stuck(bool on) noexcept { pocket_stuck_ = on; }
  void set_arm_stuck(bool on) noexcept { arm_stuck_ = on; }
  void set_clamp_stuck(bool on) noexcept { clamp_stuck_ = on; }

  [[nodiscard]] bool magazine_moves() const noexcept { return magazine_direction_ != 0; }
  [[nodiscard]] bool arm_moves() const noexcept { return grip_.moves() || exchange_.moves(); }
  [[nodiscard]] bool arm_is_home() const noexcept { return grip_.is_back(); }
  [[nodiscard]] bool tool_is_clamped() const noexcept { return clamp_.is_back(); }
  /// 0 = none.
  [[nodiscard]] std::uint16_t tool_in_spindle() const noexcept { return tool_in_spindle_; }
  /// @param pocket  1 to 12
  [[nodiscard]] std::uint16_t tool_in_pocket(std::size_t pocket) const noexcept { return tools_[pocket - 1]; }
  /// @return the pocket nearest to the change position, 1 to 12
  [[nodiscard]] std::size_t pocket_at_change() const noexcept;

 private:
  void run(std::chrono::nanoseconds elapsed) noexcept;
  void take_orders(const Terminals& terminals, bool powered) noexcept;
  [[nodiscard]] bool pocket_stands() const noexcept;

  std::array<std::uint16_t, pockets_count> tools_{};
  std::uint16_t tool_in_spindle_ = 0;
  std::chrono::nanoseconds position_{0};  ///< within one turn
  int magazine_direction_ = 0;
  Travel pocket_{pocket_down_time};
  Travel grip_{arm_grip_time};
  Travel exchange_{arm_exchange_time};
  Travel clamp_{clamp_time};  ///< out = unclamped
  bool exchanged_ = false;
  bool jammed_ = false;
  bool both_ways_ = false;
  bool magazine_overload_ = false;
  bool magazine_stuck_ = false;
  bool pulse_lost_ = false;
  bool pocket_stuck_ = false;
  bool arm_stuck_ = false;
  bool clamp_stuck_ = false;
  SteadyTime last_{};
  bool has_run_ = false;
};

}  // namespace emulator_models::machine_tool
