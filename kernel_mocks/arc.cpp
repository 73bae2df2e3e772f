#include "kernel_mocks/arc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kernel_mocks {
namespace {

constexpr double turn = 2 * std::numbers::pi;
/// Start and end of an arc may differ so much in their distance from the centre: programs are rounded.
constexpr double radius_tolerance_mm = 0.02;

}  // namespace

Arc::Arc(PlanePoint end, PlanePoint centre, bool clockwise) noexcept
    : end_{end},
      centre_{centre},
      radius_{std::hypot(centre.first, centre.second)},
      sweep_{0},
      clockwise_{clockwise} {
  sweep_ = turned_at(std::atan2(end.second - centre.second, end.first - centre.first));
}

tl::expected<Arc, NcFault> Arc::by_radius(PlanePoint end, double radius_mm, bool clockwise) {
  const double radius = std::abs(radius_mm);
  const double chord = std::hypot(end.first, end.second);
  if (chord == 0 || chord / 2 > radius + radius_tolerance_mm) {
    return tl::unexpected{NcFault::arc_radius_too_small};
  }
  // From the middle of the chord at a right angle: to its left when the shorter arc turns counter-clockwise.
  const double away = std::sqrt(std::max(0.0, radius * radius - chord * chord / 4));
  const double left = (clockwise == (radius_mm < 0) ? away : -away) / chord;
  return Arc{end, {end.first / 2 - left * end.second, end.second / 2 + left * end.first}, clockwise};
}

tl::expected<Arc, NcFault> Arc::by_centre(PlanePoint end, PlanePoint centre, bool clockwise) {
  const double radius = std::hypot(centre.first, centre.second);
  if (radius == 0) return tl::unexpected{NcFault::arc_radius_too_small};
  if (std::abs(std::hypot(end.first - centre.first, end.second - centre.second) - radius) >
      radius_tolerance_mm) {
    return tl::unexpected{NcFault::arc_end_off_circle};
  }
  Arc arc{end, centre, clockwise};
  if (end.first == 0 && end.second == 0) arc.sweep_ = turn;
  return arc;
}

void Arc::add_turns(double count) noexcept { sweep_ += turn * count; }

double Arc::turned_at(double angle) const noexcept {
  const double from_start = angle - std::atan2(-centre_.second, -centre_.first);
  double turned = std::fmod(clockwise_ ? -from_start : from_start, turn);
  if (turned < 0) turned += turn;
  return turned;
}

Arc::Bounds Arc::bounds() const noexcept {
  Bounds bounds{{std::min(0.0, end_.first), std::min(0.0, end_.second)},
                {std::max(0.0, end_.first), std::max(0.0, end_.second)}};
  const auto passes = [this](double angle) { return turned_at(angle) <= sweep_; };
  if (passes(0)) bounds.max.first = std::max(bounds.max.first, centre_.first + radius_);
  if (passes(turn / 4)) bounds.max.second = std::max(bounds.max.second, centre_.second + radius_);
  if (passes(turn / 2)) bounds.min.first = std::min(bounds.min.first, centre_.first - radius_);
  if (passes(turn * 3 / 4)) bounds.min.second = std::min(bounds.min.second, centre_.second - radius_);
  return bounds;
}

}  // namespace kernel_mocks
