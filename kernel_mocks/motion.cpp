#include "kernel_mocks/motion.hpp"

#include <algorithm>
#include <cmath>

#include "kernel_mocks/arc.hpp"

namespace kernel_mocks {
namespace {

constexpr double mm_per_inch = 25.4;
/// Sums of rounded numbers end beside their place by less than this.
constexpr double travel_tolerance = 1e-6;

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
  if (arc) return along_arc(block, target);
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

MotionPlanner::Planned MotionPlanner::along_arc(const Block& block, const Position& target) {
  // First and second axis of the plane in the sense in which G3 turns from one to the other, and the third.
  const std::size_t first = plane_ == 170 ? 0 : plane_ == 180 ? 2 : 1;
  const std::size_t second = (first + 1) % 3;
  const std::size_t third = (first + 2) % 3;
  const PlanePoint end{target[first] - position_[first], target[second] - position_[second]};
  const bool clockwise = motion_ == 20;
  const Word* const radius = block.find('R');
  const auto centre = [&](std::size_t axis) {
    const Word* const offset = block.find("IJK"[axis]);
    const double value = offset == nullptr ? 0 : number(*offset) * mm_per_unit_;
    return absolute_centre_ ? value + offset_[axis] - position_[axis] : value;
  };
  auto arc = radius != nullptr ? Arc::by_radius(end, number(*radius) * mm_per_unit_, clockwise)
                               : Arc::by_centre(end, {centre(first), centre(second)}, clockwise);
  if (!arc) return tl::unexpected{error_at(arc.error(), block, radius)};
  if (const Word* const turns = block.find('P')) arc->add_turns(std::max(0.0, number(*turns) - 1));

  const Arc::Bounds bounds = arc->bounds();
  Position corner = position_;
  for (const PlanePoint& point : {bounds.min, bounds.max}) {
    corner[first] = position_[first] + point.first;
    corner[second] = position_[second] + point.second;
    if (const auto axis = axis_beyond_travel(corner)) {
      return tl::unexpected{error_at(NcFault::beyond_axis_limit, block, block.find(axis_letters[*axis]))};
    }
  }
  return feed_to(block, target, std::hypot(arc->length_mm(), target[third] - position_[third]));
}

std::optional<std::size_t> MotionPlanner::axis_beyond_travel(const Position& position) const {
  for (std::size_t axis = 0; axis < axis_count; ++axis) {
    const auto& travel = options_.travel[axis];
    if (travel &&
        (position[axis] < travel->min - travel_tolerance || position[axis] > travel->max + travel_tolerance))
      return axis;
  }
  return std::nullopt;
}

MotionPlanner::Planned MotionPlanner::arrive(const Block& block, const Position& target, MotionKind kind,
                                             double minutes) {
  if (const auto axis = axis_beyond_travel(target)) {
    return tl::unexpected{error_at(NcFault::beyond_axis_limit, block, block.find(axis_letters[*axis]))};
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
