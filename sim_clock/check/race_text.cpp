#include "sim_clock/check/race_text.hpp"

#include <fmt/format.h>

#include "sim_clock/check/source_locations.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

std::string_view verb(const Race::Side& side) noexcept {
  if (side.plain) return side.writes ? "writes" : "reads";
  return side.writes ? "atomically writes" : "atomically reads";
}

std::string at(std::uint32_t site) {
  const std::string& location = source_location(site);
  return location.empty() ? "at a place without debug information" : "at " + location;
}

}  // namespace

std::string describe(const Race& race, const World& world) {
  Operation operation{.kind = race.one.writes ? OperationKind::write : OperationKind::read,
                      .bytes = race.bytes};
  if (race.place < segment_places_count) {
    operation.object = world.segments().segment_at(race.place);
    operation.offset = Segments::offset_in_segment(race.place);
  } else {
    const ProgramMemory::Place place = ProgramMemory::of(race.place);
    operation.object = place.object;
    operation.offset = place.offset;
  }
  return fmt::format("{} {} {} {} while {} {} it {}, and nothing orders the two",
                     world.scheduler().task(race.one.task).name, verb(race.one),
                     world.objects().place(operation), at(race.one.site),
                     world.scheduler().task(race.other.task).name, verb(race.other), at(race.other.site));
}

}  // namespace ltsim
