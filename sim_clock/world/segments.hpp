// Shared memory of the simulated world: POSIX shared memory objects, their descriptors and their mappings.
//
// Each simulated process maps a segment at addresses of its own, as on a real machine, and all mappings show
// the same bytes: every (process, segment, n-th mapping) has a window, and all windows lie in one reserved
// range, so that "is this address shared?" is one subtraction and one comparison. Windows are mapped on first
// use and then kept; after that a mapping costs no system call.
//
// Not here: files. Descriptors of shared memory objects are numbered from first_descriptor on; all others are
// real.
#pragma once

#include <sys/stat.h>
#include <sys/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/check/race_detector.hpp"
#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

class Segments {
 public:
  static constexpr unsigned window_shift = 24;
  static constexpr std::size_t segment_bytes_max = std::size_t{1} << window_shift;  // 16 MiB
  static constexpr std::size_t segments_max = 8;  // in one execution, unlinked ones included
  static constexpr std::size_t processes_max = ltsim::processes_max;
  static constexpr std::size_t mappings_max = 4;  // of one segment in one process, at a time
  static constexpr std::size_t windows_count = processes_max * segments_max * mappings_max;
  /// Far below where Linux puts the program, its heap and its libraries, far above what is refused to user
  /// code.
  static constexpr std::uintptr_t range_begin = std::uintptr_t{1} << 40U;
  static constexpr std::size_t range_bytes = windows_count << window_shift;
  static constexpr int first_descriptor = 1 << 24;
  static_assert(segments_max << window_shift == segment_places_count);

  [[nodiscard]] static bool contains(const volatile void* address) noexcept {
    return reinterpret_cast<std::uintptr_t>(address) - range_begin < range_bytes;
  }
  [[nodiscard]] static bool is_descriptor(int descriptor) noexcept { return descriptor >= first_descriptor; }

  explicit Segments(World& world);
  ~Segments();
  Segments(const Segments&) = delete;
  Segments& operator=(const Segments&) = delete;
  void reset() noexcept;

  /// At set-up: an object that is there already, with this content.
  void leave(std::string_view path, std::span<const std::byte> content);

  // The calls, for the running task; errors as POSIX.1-2017 lists them, in errno.
  int open(std::string_view path, int flags) noexcept;
  int unlink(std::string_view path) noexcept;
  int resize(int descriptor, off_t bytes) noexcept;
  int status(int descriptor, struct stat& into) noexcept;
  int close(int descriptor) noexcept;
  /// Of the segment; empty for a descriptor that is closed or never was.
  [[nodiscard]] std::string_view name_of(int descriptor) noexcept {
    const Segment* const segment = of_descriptor(descriptor);
    return segment == nullptr ? std::string_view{} : segment->name;
  }
  void* map(std::size_t bytes, int protection, int flags, int descriptor, off_t offset) noexcept;
  int unmap(void* address, std::size_t bytes) noexcept;

  // Segments that no name leads to, for the running task's System V calls.
  /// @param name   for messages
  /// @param bytes  more than that can be, if they are more than segment_bytes_max, ends the execution as unsupported
  /// @return       its place among the segments
  [[nodiscard]] std::size_t create_unnamed(std::string_view name, std::size_t bytes);
  /// @return where all of it lies for the process
  void* attach(std::size_t segment, std::size_t bytes, bool writable) noexcept;
  /// @return 0, or -1 with EINVAL in errno if no mapping of the process begins there
  int detach(const void* address) noexcept;
  /// Of all processes.
  [[nodiscard]] std::size_t mappings_of(std::size_t segment) const noexcept;

  /// The running task is about to access memory in the range. Ends the execution as a crash if the task's process has not
  /// mapped the address (any more), or not for writing, or if it lies behind the end of its segment.
  /// @param site  as in Operation
  /// @return      what the scheduling point is for that comes next
  [[nodiscard]] Operation arrive(const volatile void* address, std::size_t bytes, OperationKind kind,
                                 std::uint32_t site) noexcept;
  /// After that point the task makes the access, unless the mapping has gone meanwhile. Plain accesses are checked for races;
  /// atomic ones are to be, when they were made (MemoryChecks::atomic()).
  /// @param operation   from arrive()
  /// @param others_ran  while the task stood at the point
  void go_on(const volatile void* address, const Operation& operation, bool others_ran) noexcept;
  /// A write that go_on() was told in pieces is about to be made as a whole, in one step.
  void announce_write(const volatile void* address, std::size_t bytes) noexcept;
  /// The simulator itself has just changed these bytes: a state of its own that lies there, a fault. Outside
  /// the range it does nothing. Whatever else changes without go_on() is noticed and ends the exploration.
  void accept_change(const volatile void* address, std::size_t bytes) noexcept;
  void accept_change(ObjectId segment, std::uint32_t offset, std::size_t bytes) noexcept;
  /// Ends the execution as unsupported if memory is not as the accesses of its tasks have left it.
  void check_all_memory();

  [[nodiscard]] static SharedPlace place_of(const volatile void* address) noexcept {
    return static_cast<SharedPlace>(canonical(address));
  }
  [[nodiscard]] static std::uint32_t offset_in_segment(SharedPlace place) noexcept {
    return place & (segment_bytes_max - 1);
  }
  [[nodiscard]] ObjectId segment_at(SharedPlace place) const noexcept {
    return segments_[place >> window_shift].object;
  }
  /// The bytes of all segments, by place.
  [[nodiscard]] const std::byte* memory() const noexcept { return all_; }

  /// The process is gone, and with it its mappings and descriptors. What is in the segments stays.
  void process_died(ProcessId process) noexcept;

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;
  /// What memory holds now where `operation` acts, as an unsigned number; of longer accesses the first eight
  /// bytes.
  [[nodiscard]] std::uint64_t value_at(const Operation& operation) const noexcept;

  /// Key under which tasks wait for a synchronisation object at this address: equal for all mappings of the
  /// same bytes.
  [[nodiscard]] static WaitKey canonical(const volatile void* address) noexcept {
    const auto raw = reinterpret_cast<std::uintptr_t>(address);
    if (!contains(address)) return raw;
    const std::uint64_t segment = segment_of_window(window_of(address));
    return std::uint64_t{1} << 63U | segment << window_shift | (raw & (segment_bytes_max - 1));
  }

 private:
  struct Segment {
    std::string name;
    ObjectId object = 0;
    std::size_t bytes = 0;
    bool linked = false;
    /// All its bytes from here on are zero, in the memory and in the copy that the checks keep; kept between
    /// executions. Bytes of the segment itself count as used, those behind it once they were accessed.
    std::size_t used_bytes = 0;
  };
  struct Window {
    bool has_memory = false;  // the address range is backed by the segment's bytes; kept between executions
    bool mapped = false;      // the simulated process has it mapped
    bool writable = false;
    std::size_t bytes = 0;  // from the window's begin, as mapped
  };

  [[nodiscard]] static std::size_t window_of(const volatile void* address) noexcept {
    return (reinterpret_cast<std::uintptr_t>(address) - range_begin) >> window_shift;
  }
  [[nodiscard]] static std::size_t process_of_window(std::size_t window) noexcept {
    return window / (mappings_max * segments_max);
  }
  [[nodiscard]] static std::size_t segment_of_window(std::size_t window) noexcept {
    return window / mappings_max % segments_max;
  }
  struct Descriptor {
    std::size_t segment;
    ProcessId process;
    bool open = true;
    bool writable = false;
  };
  struct Place {
    ObjectId object;
    std::uint32_t offset;
  };
  /// Ends the execution as a crash if the running task cannot access the address so.
  [[nodiscard]] Place locate(const volatile void* address, std::size_t bytes, OperationKind kind) noexcept;
  void changed_unseen(SharedPlace place, std::string_view noticed);
  [[nodiscard]] Segment* find(std::string_view name) noexcept;
  /// Ends the execution as unsupported if there is no room for it.
  Segment& create(std::string_view name);
  /// @param bytes  from its first byte on
  /// @return       where the segment begins for the running task's process
  std::byte* map_window(std::size_t segment, std::size_t bytes, bool writable) noexcept;
  /// @param bytes  more than it has
  void grow(Segment& segment, std::size_t bytes) noexcept;
  /// @return null for a descriptor that is closed or never was
  [[nodiscard]] Descriptor* find_descriptor(int descriptor) noexcept;
  [[nodiscard]] Segment* of_descriptor(int descriptor) noexcept;
  [[nodiscard]] std::size_t index_of(const Segment& segment) const noexcept {
    return static_cast<std::size_t>(&segment - segments_.data());
  }

  World& world_;
  int memory_ = -1;           // memfd with the bytes of all segments, one after the other
  std::byte* all_ = nullptr;  // the simulator's own mapping of it
  std::array<Segment, segments_max> segments_;
  std::size_t segments_count_ = 0;
  std::array<Window, windows_count> windows_;
  std::vector<Descriptor> descriptors_;
};

}  // namespace ltsim
