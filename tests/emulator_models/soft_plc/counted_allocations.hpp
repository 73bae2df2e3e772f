// How often memory was taken from the heap or given back: to show that a scan does neither.
#pragma once

#include <cstdint>

namespace emulator_models::soft_plc {

/// Calls of operator new and delete of this thread.
[[nodiscard]] std::uint64_t heap_calls_count() noexcept;

}  // namespace emulator_models::soft_plc
