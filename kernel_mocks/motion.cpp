#include "kernel_mocks/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kernel_mocks {
namespace {

constexpr double mm_per_inch = 25.4;
/// Start and end of an arc may differ so much in their distance from the centre: programs are rounded.
constexpr double radius_tolerance_mm = 0.02;

double number(const Word& word) {
  return static_cast<double>(word.value.units()) / static_cast<double>(Decimal::units_per_one);
}

std::optional<GTenths> g_of(const Block& block, GGroup group) {
  for (const Word& word : block.words) {
    if (word.letter == 'G' && g_group(*g_tenths(word.value)) == group) return g_tenths(word.value);
  }
  return std::nullopt;
}

bool has_axis(const Block& block) {
  return std::ranges::any_of(
      block.words, [](const Word& word) { return axis_letters.find(word.letter) != std::string_view::npos; });
}

NcError error_at(NcFault fault, const Block& block, const Word* word) {
  return {fault, block.line, word == nullptr ? "" : to_string(*word)};
}

bool is_rotary(std::size_t axis) { return axis >= 3 && axis <= 5; }

}  // namespace

MotionPlanner::Planned MotionPlanner::plan(const Block& block) {
  take_modes(block);
  const auto non_modal = g_of(block, GGroup::non_modal);
  if (non_modal == GTenths{40}) {
    // The time of a dwell is in seconds, whatever the units.
    return arrive(block, position_, MotionKind::dwell, number(*block.find('P')) / 60);
  }
  if (non_modal && *non_modal >= 920 && *non_modal <= 923) return set_offset(block, *non_modal);
  if (non_modal == GTenths{280} || non_modal == GTenths{300}) return to_reference(block);

  const bool arc =
      (motion_ == 20 || motion_ == 30) && (block.find('I') != nullptr || block.find('J') != nullptr ||
                                           block.find('K') != nullptr || block.find('R') != nullptr);
  if (!has_axis(block) && !arc) return std::nullopt;
  const Position target = target_of(block, non_modal == GTenths{530});
  if (arc) {
    const auto length = arc_length(block, target);
    if (!length) return tl::unexpected{error_at(length.error(), block, block.find('R'))};
    return feed_to(block, target, *length);
  }
  if (motion_ == 0) return arrive(block, target, MotionKind::rapid, rapid_minutes(position_, target));
  const auto distance = [&](std::initializer_list<std::size_t> axes) {
    double squares = 0;
    for (const std::size_t axis : axes) squares += std::pow(target[axis] - position_[axis], 2);
    return std::sqrt(squares);
  };
  // The feed is that of X, Y, Z; of U, V, W when those stand; of the rotary axes, in degrees, when all others do.
  double length = distance({0, 1, 2});
  if (length == 0) length = distance({6, 7, 8});
  if (length == 0) length = distance({3, 4, 5});
  return feed_to(block, target, length);
}

void MotionPlanner::take_modes(const Block& block) {
  motion_ = g_of(block, GGroup::motion).value_or(motion_);
  plane_ = g_of(block, GGroup::plane).value_or(plane_);
  feed_mode_ = g_of(block, GGroup::feed_mode).value_or(feed_mode_);
  if (const auto code = g_of(block, GGroup::distance)) absolute_ = *code == 900;
  if (const auto code = g_of(block, GGroup::arc_distance)) absolute_centre_ = *code == 901;
  if (const auto code = g_of(block, GGroup::diameter)) diameter_ = *code == 70;
  if (const auto code = g_of(block, GGroup::units)) mm_per_unit_ = *code == 200 ? mm_per_inch : 1;
  if (const Word* const feed = block.find('F')) {
    feed_ = number(*feed) * (feed_mode_ == 930 ? 1 : mm_per_unit_);
  }
  if (const Word* const speed = block.find('S')) speed_ = number(*speed);
}

double MotionPlanner::scaled(std::size_t axis, const Word& word) const {
  const double value = number(word) * (is_rotary(axis) ? 1 : mm_per_unit_);
  return axis == 0 && diameter_ ? value / 2 : value;
}

MotionPlanner::Position MotionPlanner::target_of(const Block& block, bool machine_coordinates) const {
  Position target = position_;
  for (std::size_t axis = 0; axis < axis_count; ++axis) {
    const Word* const word = block.find(axis_letters[axis]);
    if (word == nullptr) continue;
    const double value = scaled(axis, *word);
    if (machine_coordinates) {
      target[axis] = value;
    } else {
      target[axis] = absolute_ ? value + offset_[axis] : position_[axis] + value;
    }
  }
  return target;
}

MotionPlanner::Planned MotionPlanner::set_offset(const Block& block, GTenths code) {
  if (code == 920) {
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
      const Word* const word = block.find(axis_letters[axis]);
      if (word != nullptr) offset_[axis] = position_[axis] - scaled(axis, *word);
    }
    kept_offset_ = offset_;
  } else {
    offset_ = code == 923 ? kept_offset_ : Position{};
    if (code == 921) kept_offset_ = {};
  }
  return std::nullopt;
}

// By way of the programmed point to zero, both at rapid rate; without axis words all axes go.
MotionPlanner::Planned MotionPlanner::to_reference(const Block& block) {
  const Position between = target_of(block, false);
  Position reference = between;
  for (std::size_t axis = 0; axis < axis_count; ++axis) {
    if (!has_axis(block) || block.find(axis_letters[axis]) != nullptr) reference[axis] = 0;
  }
  const double minutes = rapid_minutes(position_, between) + rapid_minutes(between, reference);
  if (auto there = arrive(block, between, MotionKind::rapid, 0); !there) return there;
  return arrive(block, reference, MotionKind::rapid, minutes);
}

MotionPlanner::Planned MotionPlanner::feed_to(const Block& block, const Position& target, double length_mm) {
  double minutes = 0;
  if (feed_mode_ == 930) {
    minutes = 1 / feed_;
  } else if (feed_mode_ == 950) {
    if (speed_ == 0) {
      return tl::unexpected{error_at(NcFault::feed_per_revolution_without_speed, block, nullptr)};
    }
    minutes = length_mm / (feed_ * speed_);
  } else {
    minutes = length_mm / feed_;
  }
  return arrive(block, target, MotionKind::feed, std::max(minutes, rapid_minutes(position_, target)));
}

double MotionPlanner::rapid_minutes(const Position& from, const Position& to) const {
  double minutes = 0;
  for (std::size_t axis = 0; axis < axis_count; ++axis) {
    minutes = std::max(minutes, std::abs(to[axis] - from[axis]) / options_.rapid[axis]);
  }
  return minutes;
}

tl::expected<double, NcFault> MotionPlanner::arc_length(const Block& block, const Position& target) const {
  // First and second axis of the plane in the sense in which G3 turns from one to the other, and the third.
  const std::size_t first = plane_ == 170 ? 0 : plane_ == 180 ? 2 : 1;
  const std::size_t second = (first + 1) % 3;
  const std::size_t third = (first + 2) % 3;
  const double along_first = target[first] - position_[first];
  const double along_second = target[second] - position_[second];
  const double chord = std::hypot(along_first, along_second);
  const double full = 2 * std::numbers::pi;
  double radius = 0;
  double sweep = 0;
  if (const Word* const word = block.find('R')) {
    radius = std::abs(number(*word)) * mm_per_unit_;
    if (chord == 0 || chord / 2 > radius + radius_tolerance_mm)
      return tl::unexpected{NcFault::arc_radius_too_small};
    sweep = 2 * std::asin(std::min(1.0, chord / 2 / radius));
    // A negative radius chooses the longer of the two arcs.
    if (word->value.is_negative()) sweep = full - sweep;
  } else {
    const auto centre = [&](std::size_t axis) {
      const Word* const offset = block.find("IJK"[axis]);
      const double value = offset == nullptr ? 0 : number(*offset) * mm_per_unit_;
      return absolute_centre_ ? value + offset_[axis] - position_[axis] : value;
    };
    const double c1 = centre(first);
    const double c2 = centre(second);
    radius = std::hypot(c1, c2);
    if (radius == 0) return tl::unexpected{NcFault::arc_radius_too_small};
    if (std::abs(std::hypot(along_first - c1, along_second - c2) - radius) > radius_tolerance_mm) {
      return tl::unexpected{NcFault::arc_end_off_circle};
    }
    sweep = std::atan2(along_second - c2, along_first - c1) - std::atan2(-c2, -c1);
    if (motion_ == 20) sweep = -sweep;
    // An end at the start is a full circle, not none.
    if (chord == 0) sweep = full;
    while (sweep <= 0) sweep += full;
    while (sweep > full) sweep -= full;
  }
  if (const Word* const turns = block.find('P')) sweep += full * std::max(0.0, number(*turns) - 1);
  return std::hypot(radius * sweep, target[third] - position_[third]);
}

MotionPlanner::Planned MotionPlanner::arrive(const Block& block, const Position& target, MotionKind kind,
                                             double minutes) {
  for (std::size_t axis = 0; axis < axis_count; ++axis) {
    const auto& travel = options_.travel[axis];
    if (travel && (target[axis] < travel->min || target[axis] > travel->max)) {
      return tl::unexpected{error_at(NcFault::beyond_axis_limit, block, block.find(axis_letters[axis]))};
    }
  }
  const double nanoseconds = minutes * 60e9;
  if (!(nanoseconds <= static_cast<double>(std::chrono::nanoseconds{motion_duration_max}.count()))) {
    return tl::unexpected{error_at(NcFault::motion_too_long, block, nullptr)};
  }
  position_ = target;
  const std::chrono::nanoseconds duration{std::llround(nanoseconds) / 100 * options_.time_percent +
                                          std::llround(nanoseconds) % 100 * options_.time_percent / 100};
  return Motion{kind, duration, position_[z_axis]};
}

tl::expected<void, NcError> check_motion(const Program& program, const AxisOptions& axes) {
  MotionPlanner planner{axes};
  for (const Block& block : program.blocks) {
    if (const auto planned = planner.plan(block); !planned) return tl::unexpected{planned.error()};
  }
  return {};
}

}  // namespace kernel_mocks
