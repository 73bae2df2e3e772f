// Which orders of memory accesses the simulated machine shows.
#pragma once

#include <cstdint>
#include <string_view>

namespace ltsim {

enum class Memory : std::uint8_t {
  sc,   ///< sequentially consistent: each load sees the latest store
  c11,  ///< what C++20 allows of atomic operations by their memory orders, as far as WeakMemory shows it
};

/// "sc", "c11": as on the command line and in schedules.
[[nodiscard]] constexpr std::string_view to_string(Memory memory) noexcept {
  return memory == Memory::sc ? "sc" : "c11";
}

}  // namespace ltsim
