#include "sim_clock/trace/value_text.hpp"

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {

std::string value_text(const World& world, const Operation& operation, std::uint64_t value) {
  const auto* const pointer = reinterpret_cast<const void*>(value);
  if (!ProgramMemory::is_object(operation.object) || operation.bytes < sizeof pointer)
    return fmt::format("{}", value);
  if (const auto place = ProgramMemory::find(pointer); place) {
    const Operation there{
        .kind = OperationKind::read, .bytes = 1, .object = place->object, .offset = place->offset};
    return fmt::format("&{}", world.objects().place(there));
  }
  // What lies there is the program's code, a library or libc's memory: Linux puts them below the end of the lower half, programs
  // without a fixed place near 0x555555554000.
  constexpr std::uint64_t programs_begin = 0x550000000000;
  constexpr std::uint64_t lower_half_end = 0x800000000000;
  if (ProgramImage::contains(pointer) || (value >= programs_begin && value < lower_half_end))
    return "an address";
  return fmt::format("{}", value);
}

}  // namespace ltsim
