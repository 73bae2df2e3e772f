// One event of the executive part of a PLC, as it travels from a scan to the archive.
//
// Plain memory of a fixed size: a scan fills it in without a lock, an allocation or a system call. Texts are left
// to whoever reads the archive (archive/archive_schema.hpp); the numbers of the enumerations are stable, files keep
// them.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

namespace emulator_models::soft_plc {

/// What `code` and `values` hold is said at each kind; what is not named is 0.
enum class EventKind : std::uint8_t {
  scans = 1,    ///< whole scans of RUN in one span of time; values: count, shortest, longest, sum of the scan
                ///< times in ns, overruns
  overrun = 2,  ///< values: time of the scan in ns, or -1 in STOP
  fault = 3,    ///< code: FaultCode; values: ScanAction, scan time in ns, line and column of the program
  fault_cleared = 4,  ///< code: FaultCode
  mode_change = 5,    ///< code: RunMode
  port_write =
      6,  ///< code: memory area as the port numbers it; values: address, bytes, the first 8 bytes, and
          ///< of a write of one bit within a byte its number + 1
  signal_change = 7,  ///< code: number of the signal; values: before, after
  records_lost = 8,   ///< values: records that found no room, counted in the place where they are missing
};
inline constexpr std::uint8_t event_kinds_count = 8;

struct EventRecord {
  EventKind kind = EventKind::scans;
  std::uint8_t cycle = 0;  ///< number of the cycle, or of the port
  std::uint16_t code = 0;
  std::uint32_t reserved = 0;
  std::int64_t time_ns = 0;  ///< since power-up; of `scans` the end of the span
  std::uint64_t scan_number = 0;
  std::array<std::int64_t, 5> values{};

  friend bool operator==(const EventRecord&, const EventRecord&) = default;
};
static_assert(sizeof(EventRecord) == 64, "one cache line");
static_assert(std::is_trivially_copyable_v<EventRecord>);

}  // namespace emulator_models::soft_plc
