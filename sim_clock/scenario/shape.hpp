// SHAPE(): a known race as a pair of scenarios, the program that has it and the same program without it.
//
//     SHAPE("races/o30-lost-update", {.finding = "I14", .depth = 2, .tasks_count = 2, .cure = "one atomic update"},
//           "two sides each set a bit of one word") {
//       ... the body sees `world` and `corrected` ...
//       world.run();
//     }
//
// registers the scenarios "races/o30-lost-update", which fails with a message that begins with "I14" or with an
// outcome of that name, and "races/o30-lost-update-corrected", which never fails. What the facts say is for people
// and for tests of the search; no strategy sees it. Of the facts only the memory says how to search: whoever explores a
// shape, or its corrected program, does so with that memory. "ltsim explore" asks for it by --memory.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/check/outcome.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace ltsim {

struct ShapeFacts {
  /// How the message of an invariant begins ("I9": "I9: ..." and "I9, I29: ..." count); or an outcome's name
  /// ("deadlock").
  std::string_view finding;
  /// How many ordering constraints are enough for the failure, as probabilistic concurrency testing counts them.
  unsigned depth = 1;
  unsigned tasks_count = 2;
  Memory memory = Memory::sc;  ///< the strongest memory that shows it
  std::string_view cure;       ///< what the corrected program does instead
};

struct Shape {
  std::string_view name;            ///< of the scenario that fails
  std::string_view corrected_name;  ///< of the one that does not
  ShapeFacts facts;

  /// Whether the outcome is the failure that the shape is there to show, and no other.
  [[nodiscard]] bool is_finding(const Outcome& outcome) const noexcept;
};

/// All shapes of this program, by name.
[[nodiscard]] const std::vector<Shape>& shapes();
/// @param name  of the scenario that fails
/// @return      null if there is none of that name
[[nodiscard]] const Shape* find_shape(std::string_view name);

/// Adds the two scenarios before main().
struct ShapeRegistration {
  ShapeRegistration(std::string_view name, std::string_view corrected_name, const ShapeFacts& facts,
                    std::string_view description, void (*open)(World&), void (*corrected)(World&));
};

}  // namespace ltsim

// The facts hold commas, so they and what follows them are one variadic argument.
#define SHAPE(name, ...)                                                                   \
  static void LTSIM_JOIN(ltsim_shape_, __LINE__)(::ltsim::World & world, bool corrected);  \
  static const ::ltsim::ShapeRegistration LTSIM_JOIN(ltsim_shape_registration_, __LINE__){ \
      name, name "-corrected", __VA_ARGS__,                                                \
      [](::ltsim::World& shaped) { LTSIM_JOIN(ltsim_shape_, __LINE__)(shaped, false); },   \
      [](::ltsim::World& shaped) { LTSIM_JOIN(ltsim_shape_, __LINE__)(shaped, true); }};   \
  static void LTSIM_JOIN(ltsim_shape_, __LINE__)([[maybe_unused]] ::ltsim::World & world,  \
                                                 [[maybe_unused]] bool corrected)
