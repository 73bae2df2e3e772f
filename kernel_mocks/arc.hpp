// The circular part of a motion by G2 or G3, in its plane.
//
// Coordinates are relative to the start of the arc, mm: along the plane's first and second axis, in the sense in which
// G3 (counter-clockwise) turns from the first to the second.
#pragma once

#include <tl/expected.hpp>

#include "kernel_mocks/nc_error.hpp"

namespace kernel_mocks {

struct PlanePoint {
  double first = 0;
  double second = 0;
};

class Arc {
 public:
  /// @param radius_mm  not zero; a negative one chooses the longer of the two arcs
  /// @return           arc_radius_too_small when no such circle goes through both ends, or the ends are one
  [[nodiscard]] static tl::expected<Arc, NcFault> by_radius(PlanePoint end, double radius_mm, bool clockwise);
  /// An end at the start is a full circle, not none.
  /// @return arc_radius_too_small when the centre is the start, arc_end_off_circle
  [[nodiscard]] static tl::expected<Arc, NcFault> by_centre(PlanePoint end, PlanePoint centre,
                                                            bool clockwise);

  void add_turns(double count) noexcept;

  [[nodiscard]] double length_mm() const noexcept { return radius_ * sweep_; }

  struct Bounds {
    PlanePoint min;
    PlanePoint max;
  };
  /// The smallest rectangle that holds the way: the arc bulges between its ends.
  [[nodiscard]] Bounds bounds() const noexcept;

 private:
  Arc(PlanePoint end, PlanePoint centre, bool clockwise) noexcept;

  /// How far the arc has turned, 0 to one turn, when it comes to this direction as seen from the centre.
  [[nodiscard]] double turned_at(double angle) const noexcept;

  PlanePoint end_;
  PlanePoint centre_;
  double radius_;
  /// Above zero, whichever way it turns.
  double sweep_;
  bool clockwise_;
};

}  // namespace kernel_mocks
