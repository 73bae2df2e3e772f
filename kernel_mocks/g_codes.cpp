#include "kernel_mocks/g_codes.hpp"

#include <algorithm>
#include <array>

namespace kernel_mocks {
namespace {

struct GCode {
  GTenths code;
  GGroup group;
};

constexpr std::array g_code_table{
    GCode{0, GGroup::motion},                 // rapid
    GCode{10, GGroup::motion},                // line at feed
    GCode{20, GGroup::motion},                // arc clockwise
    GCode{30, GGroup::motion},                // arc counter-clockwise
    GCode{40, GGroup::non_modal},             // dwell
    GCode{70, GGroup::diameter},              // X is a diameter
    GCode{80, GGroup::diameter},              // X is a radius
    GCode{170, GGroup::plane},                // XY
    GCode{180, GGroup::plane},                // ZX
    GCode{190, GGroup::plane},                // YZ
    GCode{200, GGroup::units},                // inch
    GCode{210, GGroup::units},                // millimetre
    GCode{280, GGroup::non_modal},            // to the first reference position
    GCode{300, GGroup::non_modal},            // to the second reference position
    GCode{400, GGroup::cutter_compensation},  // off
    GCode{410, GGroup::cutter_compensation},  // left
    GCode{420, GGroup::cutter_compensation},  // right
    GCode{430, GGroup::tool_length},          // on
    GCode{490, GGroup::tool_length},          // off
    GCode{530, GGroup::non_modal},            // machine coordinates in this block
    GCode{540, GGroup::coordinate_system},    // work offsets 1 to 9
    GCode{550, GGroup::coordinate_system},    //
    GCode{560, GGroup::coordinate_system},    //
    GCode{570, GGroup::coordinate_system},    //
    GCode{580, GGroup::coordinate_system},    //
    GCode{590, GGroup::coordinate_system},    //
    GCode{591, GGroup::coordinate_system},    //
    GCode{592, GGroup::coordinate_system},    //
    GCode{593, GGroup::coordinate_system},    //
    GCode{610, GGroup::path_control},         // exact path
    GCode{611, GGroup::path_control},         // exact stop
    GCode{640, GGroup::path_control},         // continuous, P and Q are tolerances
    GCode{800, GGroup::motion},               // no motion in force
    GCode{900, GGroup::distance},             // absolute
    GCode{901, GGroup::arc_distance},         // centre absolute
    GCode{910, GGroup::distance},             // incremental
    GCode{911, GGroup::arc_distance},         // centre incremental
    GCode{920, GGroup::non_modal},            // coordinate offset
    GCode{921, GGroup::non_modal},            // its removal
    GCode{922, GGroup::non_modal},            //
    GCode{923, GGroup::non_modal},            // and its return
    GCode{930, GGroup::feed_mode},            // inverse time
    GCode{940, GGroup::feed_mode},            // per minute
    GCode{950, GGroup::feed_mode},            // per revolution
    GCode{970, GGroup::spindle_mode},         // S in revolutions per minute
};

}  // namespace

std::optional<GTenths> g_tenths(Decimal value) noexcept {
  constexpr std::int64_t units_per_tenth = Decimal::units_per_one / 10;
  if (value.is_negative() || value.units() % units_per_tenth != 0) return std::nullopt;
  const std::int64_t tenths = value.units() / units_per_tenth;
  if (tenths > 999) return std::nullopt;
  return static_cast<GTenths>(tenths);
}

std::optional<GGroup> g_group(GTenths code) noexcept {
  const auto found = std::ranges::find(g_code_table, code, &GCode::code);
  if (found == g_code_table.end()) return std::nullopt;
  return found->group;
}

bool is_canned_cycle(GTenths code) noexcept {
  const unsigned whole = code / 10;
  return whole == 73 || whole == 74 || whole == 76 || (whole >= 81 && whole <= 89);
}

}  // namespace kernel_mocks
