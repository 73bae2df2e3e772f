// The memory of a whole program as a thing that its tasks share: its variables, its heap, and the stacks of its tasks.
//
// Off, for scenarios: there only segments are shared. On, each access to it is a scheduling point, but
//   - while its process has made no thread: nobody is there who could notice;
//   - a plain one to the task's own stack: what others do there at the same time is a race, and found as one.
// Accesses to the heap are checked against its blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "sim_clock/check/race_detector.hpp"
#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/program_heap.hpp"
#include "sim_clock/world/program_image.hpp"

namespace ltsim {

class World;

class ProgramMemory {
 public:
  // The places behind those of the segments; see SharedPlace.
  static constexpr SharedPlace variables_first = SharedPlace{1} << 27U;
  static constexpr std::size_t variables_bytes_max = std::size_t{1} << 27U;
  static constexpr SharedPlace heap_first = SharedPlace{1} << 28U;
  static constexpr SharedPlace stacks_first = SharedPlace{1} << 29U;
  static constexpr std::size_t places_end = std::size_t{1} << 30U;

  // Objects of Operation; no world has so many others.
  static constexpr ObjectId variables_object = first_program_object;
  static constexpr ObjectId heap_object = first_program_object + 1;
  static constexpr ObjectId stacks_object = first_program_object + 2;

  struct Place {
    ObjectId object = 0;
    std::uint32_t offset = 0;
    SharedPlace place = 0;
  };

  explicit ProgramMemory(World& world) noexcept : world_(world) {}

  /// From now on, in this process, the variables, the heap and the stacks are shared memory. Before a world exists.
  /// @return nothing, or why this program cannot be taken so
  [[nodiscard]] static std::optional<std::string> turn_on();
  [[nodiscard]] static bool is_on() noexcept { return ProgramHeap::is_on(); }

  [[nodiscard]] static bool is_object(ObjectId object) noexcept {
    return object >= variables_object && object <= stacks_object;
  }
  [[nodiscard]] static std::optional<Place> find(const volatile void* address) noexcept;
  [[nodiscard]] static Place of(SharedPlace place) noexcept;

  /// The running task is about to access memory that find() has found: with its scheduling point. Ends the execution as a crash if
  /// that is no memory of the program (any more).
  void access(const volatile void* address, const Place& place, std::size_t bytes, OperationKind kind,
              std::uint32_t site, bool is_seq_cst = false) noexcept;

  /// The running task is about to use a synchronisation object. Ends the execution as a crash if it is not there (any more).
  void check_object(const void* object, std::size_t bytes, OperationKind kind) noexcept {
    if (ProgramHeap::contains(object)) check_heap(object, bytes, kind, 0);
  }

  // For the running task, or before main():
  /// @return  null: there is no room for so much
  void* allocate(std::size_t bytes, std::size_t alignment, const void* caller) noexcept;
  /// Ends the execution as a crash if no block begins there, or it is freed already.
  /// @param block  in the range of the heap
  void free(void* block, const void* caller) noexcept;
  void* reallocate(void* block, std::size_t bytes, const void* caller) noexcept;
  /// Fails if a block is not freed and nothing that can still be reached holds its address.
  /// @param stack  of the running task: only what lies above counts
  void check_leaks(const void* stack);

  /// What memory holds there now, as an unsigned number; of longer accesses the first eight bytes.
  [[nodiscard]] static std::uint64_t value_at(const Operation& operation) noexcept;

  /// "counter", "heap.main-3", "stack.main": what schedules are anchored to.
  [[nodiscard]] std::string name(const Operation& operation) const;
  /// With the byte in it: "counter[4]", if it has more than those that are accessed.
  [[nodiscard]] std::string place(const Operation& operation) const;
  [[nodiscard]] std::string name(const ProgramHeap::Block& block) const;
  /// Of a synchronisation object: "ledger_lock", "queue+40", "heap.main-3+16"; where it lies nowhere that has a name, "mutex-2".
  /// @param kind    "mutex"
  /// @param number  which of its kind
  [[nodiscard]] std::string object_name(const volatile void* address, std::string_view kind,
                                        std::size_t number) const;

 private:
  void check_heap(const volatile void* address, std::size_t bytes, OperationKind kind,
                  std::uint32_t site) noexcept;
  void fail_to_free(const void* address) noexcept;
  /// "24 bytes, allocated at x.cpp:12, freed by p/main at x.cpp:20"
  [[nodiscard]] std::string history(const ProgramHeap::Block& block) const;

  World& world_;
};

}  // namespace ltsim
