#include "sim_clock/world/program_memory.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "sim_clock/check/lost_blocks.hpp"
#include "sim_clock/check/program_symbols.hpp"
#include "sim_clock/check/source_locations.hpp"
#include "sim_clock/world/watched_accesses.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

std::uintptr_t number_of(const volatile void* address) noexcept {
  return reinterpret_cast<std::uintptr_t>(address);
}

constexpr std::uint32_t slot_bytes = std::uint32_t{1} << TaskStorage::slot_shift;
constexpr std::uint32_t no_access_bytes = slot_bytes - TaskStorage::stack_bytes;

/// Accesses are told to the checks in pieces of so many bytes at most.
constexpr std::uint32_t granule_bytes = 16;

/// Without the process: there is one.
std::string_view short_name(const Task& task) noexcept {
  const std::string_view name = task.name;
  return name.substr(name.find('/') + 1);
}

/// "kernel@2": its process, in the life that it belongs to.
std::string_view life_of(const Task& task) noexcept {
  const std::string_view name = task.name;
  return name.substr(0, name.find('/'));
}

std::string_view verb(OperationKind kind) noexcept {
  if (!is_memory_access(kind)) return to_string(kind);
  return changes_memory(kind) ? "writes" : "reads";
}

}  // namespace

std::optional<std::string> ProgramMemory::turn_on() {
  if (ProgramImage::variables_bytes() > variables_bytes_max)
    return fmt::format("the program has {} bytes of variables; more than {} cannot be followed",
                       ProgramImage::variables_bytes(), variables_bytes_max);
  ProgramHeap::begin_program();
  watch_all_accesses();
  return std::nullopt;
}

std::optional<ProgramMemory::Place> ProgramMemory::find(const volatile void* address) noexcept {
  const std::uintptr_t at = number_of(address);
  if (const std::uint32_t offset = ProgramImage::variable_at(address); offset != ProgramImage::no_variable)
    return Place{variables_object, offset, variables_first + offset};
  if (ProgramHeap::contains(address)) {
    const std::uint32_t offset = ProgramHeap::offset_of(address);
    return Place{heap_object, offset, heap_first + offset};
  }
  if (!TaskStorage::is_in_range(at)) return std::nullopt;
  const std::uintptr_t in_range = at - TaskStorage::range_begin;
  const auto in_slot = static_cast<std::uint32_t>(in_range % slot_bytes);
  if (in_slot < no_access_bytes) return std::nullopt;  // SIGSEGV will say it
  const auto offset =
      static_cast<std::uint32_t>((in_range >> TaskStorage::slot_shift) * TaskStorage::stack_bytes) + in_slot -
      no_access_bytes;
  return Place{stacks_object, offset, stacks_first + offset};
}

ProgramMemory::Place ProgramMemory::of(SharedPlace place) noexcept {
  if (place >= stacks_first) return {stacks_object, place - stacks_first, place};
  if (place >= heap_first) return {heap_object, place - heap_first, place};
  return {variables_object, place - variables_first, place};
}

void ProgramMemory::access(const volatile void* address, const Place& place, std::size_t bytes,
                           OperationKind kind, std::uint32_t site, bool is_seq_cst) noexcept {
  Operation operation{.kind = kind,
                      .bytes = static_cast<std::uint8_t>(bytes),
                      .is_seq_cst = is_seq_cst,
                      .object = place.object,
                      .offset = place.offset,
                      .site = site};
  if (place.object == heap_object) check_heap(address, bytes, kind, site);
  Scheduler& scheduler = world_.scheduler();
  if (!world_.process(current_task->process).has_made_threads()) return;
  const bool is_atomic = kind != OperationKind::read && kind != OperationKind::write;
  const bool is_on_own_stack = place.object == stacks_object &&
                               current_task->storage->slot() == place.offset / TaskStorage::stack_bytes;
  const SharedAccess shared{.task = current_task->id,
                            .place = place.place,
                            .bytes = operation.bytes,
                            .writes = changes_memory(kind),
                            .plain = !is_atomic,
                            .site = site};
  operation.is_contended = world_.checks().is_contended(shared);
  if (is_atomic || !is_on_own_stack) {
    scheduler.point(operation);
    if (place.object == heap_object)
      check_heap(address, bytes, kind, site);  // somebody may have freed it meanwhile
  }
  if (!is_atomic && world_.checks().on()) world_.checks().accessed(shared, kind == OperationKind::read);
}

void* ProgramMemory::allocate(std::size_t bytes, std::size_t alignment, const void* caller) noexcept {
  constexpr std::size_t no_machine_has = std::size_t{1} << 40U;  // so libc would have refused it, too
  if (bytes >= no_machine_has) {
    errno = ENOMEM;
    return nullptr;
  }
  void* const block = ProgramHeap::allocate(bytes, alignment, ProgramImage::site_of(caller));
  if (block == nullptr)
    world_.unsupported(fmt::format(
        "{} asked for {} bytes; the heap of a program has {} MiB here, and none lies where another was",
        current_task->name, bytes, ProgramHeap::range_bytes >> 20U));
  return block;
}

void ProgramMemory::free(void* address, const void* caller) noexcept {
  ProgramHeap::Block* block = ProgramHeap::block_that_begins_at(address);
  if (block == nullptr) fail_to_free(address);
  // Whoever uses it at the same time uses what is not there any more: a write, to all of it.
  const std::uint32_t site = ProgramImage::site_of(caller);
  if (!block->is_freed && block->bytes != 0)
    access(address, *find(address), std::min<std::size_t>(block->bytes, granule_bytes), OperationKind::write,
           site);
  block = ProgramHeap::block_that_begins_at(address);  // others ran, and may have allocated
  if (block->is_freed) fail_to_free(address);
  if (world_.checks().on() && world_.process(current_task->process).has_made_threads()) {
    for (std::uint32_t at = granule_bytes; at < block->bytes; at += granule_bytes) {
      world_.checks().accessed(
          {.task = current_task->id,
           .place = heap_first + block->offset + at,
           .bytes = static_cast<std::uint8_t>(std::min(block->bytes - at, granule_bytes)),
           .writes = true,
           .plain = true,
           .site = site},
          false);
    }
  }
  ProgramHeap::free(*block, site);
}

void* ProgramMemory::reallocate(void* address, std::size_t bytes, const void* caller) noexcept {
  const ProgramHeap::Block* const block = ProgramHeap::block_that_begins_at(address);
  if (block == nullptr || block->is_freed) fail_to_free(address);
  const std::size_t common = std::min<std::size_t>(block->bytes, bytes);
  void* const other = allocate(bytes, ProgramHeap::granule_bytes, caller);
  if (other == nullptr) return nullptr;
  std::memcpy(other, address, common);
  free(address, caller);
  return other;
}

void ProgramMemory::fail_to_free(const void* address) noexcept {
  const GhostScope ghost;
  const std::uint32_t offset = ProgramHeap::offset_of(address);
  world_.scheduler().fail_described(
      OutcomeKind::crash, [this, offset, who = world_.scheduler().running()->name] {
        const ProgramHeap::Block* const block = ProgramHeap::block_at(offset);
        if (block == nullptr) return fmt::format("{} frees an address where no block begins", who);
        if (block->offset == offset)
          return fmt::format("{} frees {} again: {}", who, name(*block), history(*block));
        return fmt::format("{} frees an address where no block begins: {}[{}]", who, name(*block),
                           offset - block->offset);
      });
}

std::string ProgramMemory::history(const ProgramHeap::Block& block) const {
  const auto at = [](std::uint32_t site) {
    const std::string& location = source_location(site);
    return location.empty() ? std::string{} : " at " + location;
  };
  std::string text = fmt::format("{} bytes, allocated{}", block.bytes, at(block.site));
  if (block.is_freed)
    text += fmt::format(
        ", freed{}{}",
        block.freed_by == ProgramHeap::no_owner ? "" : " by " + world_.scheduler().task(block.freed_by).name,
        at(block.freed_site));
  return text;
}

void ProgramMemory::check_leaks(const void* stack) {
  if (!world_.findings().leaks) return;
  const GhostScope ghost;
  std::vector<std::size_t> lost = lost_blocks(world_, stack);
  // Nothing of another process is lost by this one, and what a killed life has left the system takes back.
  const Scheduler& scheduler = world_.scheduler();
  const Task& self = *scheduler.running();
  std::erase_if(lost, [&](std::size_t each) {
    const ProgramHeap::Block& block = ProgramHeap::blocks()[each];
    return block.owner == ProgramHeap::no_owner ? ProgramHeap::image_of(block) != self.process
                                                : life_of(scheduler.task(block.owner)) != life_of(self);
  });
  if (lost.empty()) return;
  world_.scheduler().fail_described(OutcomeKind::leak, [this, lost = std::move(lost)] {
    std::string text;
    for (const std::size_t each : lost) {
      const ProgramHeap::Block& block = ProgramHeap::blocks()[each];
      text += fmt::format("{}{} is lost: {}", text.empty() ? "" : "; ", name(block), history(block));
    }
    return text;
  });
}

void ProgramMemory::check_heap(const volatile void* address, std::size_t bytes, OperationKind kind,
                               std::uint32_t site) noexcept {
  const ProgramHeap::Access access = ProgramHeap::check(address, bytes);
  if (access == ProgramHeap::Access::valid) [[likely]]
    return;
  const GhostScope ghost;
  const std::uint32_t offset = ProgramHeap::offset_of(address);
  world_.scheduler().fail_described(OutcomeKind::crash, [this, offset, bytes, kind, site, access,
                                                         who = world_.scheduler().running()->name] {
    const ProgramHeap::Block* const block = ProgramHeap::block_at(offset);
    const std::string& location = source_location(site);
    const std::string begin =
        fmt::format("{} {}{} ", who, verb(kind), location.empty() ? "" : " at " + location + ":");
    if (block == nullptr) return begin + "the heap where no block is";
    const std::string what = fmt::format("{}[{}]", name(*block), offset - block->offset);
    return access == ProgramHeap::Access::freed
               ? fmt::format("{}{} after it was freed: {}", begin, what, history(*block))
               : fmt::format("{}{} bytes at {}, beyond its end: {}", begin, bytes, what, history(*block));
  });
}

std::uint64_t ProgramMemory::value_at(const Operation& operation) noexcept {
  const std::byte* at = nullptr;
  if (operation.object == variables_object) {
    const std::size_t image = ProgramImage::image_of_variable(operation.offset);
    at = ProgramImage::variables(image).data() + (operation.offset - ProgramImage::first_variable(image));
  } else if (operation.object == heap_object) {
    at = static_cast<const std::byte*>(ProgramHeap::address_of(operation.offset));
  } else {
    const std::size_t slot = operation.offset / TaskStorage::stack_bytes;
    at = reinterpret_cast<const std::byte*>(TaskStorage::range_begin + (slot << TaskStorage::slot_shift) +
                                            no_access_bytes + operation.offset % TaskStorage::stack_bytes);
  }
  std::uint64_t value = 0;
  std::memcpy(&value, at, std::min<std::size_t>(operation.bytes, sizeof value));
  return value;
}

std::string ProgramMemory::name(const ProgramHeap::Block& block) const {
  return block.owner == ProgramHeap::no_owner
             ? fmt::format("heap.start-{}", block.number)
             : fmt::format("heap.{}-{}", short_name(world_.scheduler().task(block.owner)), block.number);
}

std::string ProgramMemory::object_name(const volatile void* address, std::string_view kind,
                                       std::size_t number) const {
  const auto with_offset = [](std::string of, std::uint32_t offset) {
    return offset == 0 ? of : fmt::format("{}+{}", of, offset);
  };
  const auto place = is_on() ? find(address) : std::nullopt;
  const auto numbered = [&] { return fmt::format("{}-{}", kind, number); };
  if (!place || place->object == stacks_object) return numbered();
  if (place->object == variables_object) {
    const ProgramSymbol& symbol = symbol_at(place->offset);
    return with_offset(symbol.name, place->offset - symbol.offset);
  }
  const ProgramHeap::Block* const block = ProgramHeap::block_at(place->offset);
  return block == nullptr ? numbered() : with_offset(name(*block), place->offset - block->offset);
}

std::string ProgramMemory::name(const Operation& operation) const {
  if (operation.object == variables_object) return symbol_at(operation.offset).name;
  if (operation.object == heap_object) {
    const ProgramHeap::Block* const block = ProgramHeap::block_at(operation.offset);
    return block == nullptr ? "heap" : name(*block);
  }
  const std::size_t slot = operation.offset / TaskStorage::stack_bytes;
  const Scheduler& scheduler = world_.scheduler();
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    if (task.storage->slot() == slot) return fmt::format("stack.{}", short_name(task));
  }
  return "stack";
}

std::string ProgramMemory::place(const Operation& operation) const {
  const std::string of_what = name(operation);
  if (operation.object == variables_object) {
    const ProgramSymbol& symbol = symbol_at(operation.offset);
    if (symbol.bytes <= operation.bytes) return of_what;
    return fmt::format("{}[{}]", of_what, operation.offset - symbol.offset);
  }
  if (operation.object == heap_object) {
    const ProgramHeap::Block* const block = ProgramHeap::block_at(operation.offset);
    if (block == nullptr || block->bytes <= operation.bytes) return of_what;
    return fmt::format("{}[{}]", of_what, operation.offset - block->offset);
  }
  return fmt::format("{}[-{}]", of_what,
                     TaskStorage::stack_bytes - operation.offset % TaskStorage::stack_bytes);
}

}  // namespace ltsim
