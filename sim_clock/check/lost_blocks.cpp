#include "sim_clock/check/lost_blocks.hpp"

#include <link.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

class Search {
 public:
  Search() : found_(ProgramHeap::blocks().size(), false) {}

  void look_at(std::uintptr_t word) {
    if (!ProgramHeap::contains(reinterpret_cast<const void*>(word))) return;
    const auto offset = ProgramHeap::offset_of(reinterpret_cast<const void*>(word));
    const ProgramHeap::Block* const block = ProgramHeap::block_at(offset);
    // The address right behind a block is one that a loop over it ends with.
    if (block == nullptr || block->is_freed || offset > block->offset + block->bytes) return;
    const auto index = static_cast<std::size_t>(block - ProgramHeap::blocks().data());
    if (found_[index]) return;
    found_[index] = true;
    to_look_at_.push_back(index);
  }

  void look_at(const void* begin, const void* end) {
    const auto* word = reinterpret_cast<const std::uintptr_t*>((reinterpret_cast<std::uintptr_t>(begin) + 7) &
                                                               ~std::uintptr_t{7});
    for (; word + 1 <= end; ++word) look_at(*word);
  }

  /// Those that nothing looked at so far leads to.
  std::vector<std::size_t> lost() {
    const auto blocks = ProgramHeap::blocks();
    while (!to_look_at_.empty()) {
      const ProgramHeap::Block& block = blocks[to_look_at_.back()];
      to_look_at_.pop_back();
      const auto* const begin = static_cast<const std::byte*>(ProgramHeap::address_of(block.offset));
      look_at(begin, begin + block.bytes);
    }
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (!found_[i] && !blocks[i].is_freed) all.push_back(i);
    }
    return all;
  }

 private:
  std::vector<bool> found_;
  std::vector<std::size_t> to_look_at_;
};

/// Variables of the libraries, but not of the one that this code is in: what the simulator notes is not the program's.
int look_at_library(dl_phdr_info* module, std::size_t /*size*/, void* search) {
  const auto own = reinterpret_cast<std::uintptr_t>(&look_at_library);
  const std::span headers{module->dlpi_phdr, module->dlpi_phnum};
  const auto begin_of = [&](const ElfW(Phdr) & header) { return module->dlpi_addr + header.p_vaddr; };
  const bool is_own = std::any_of(headers.begin(), headers.end(), [&](const ElfW(Phdr) & header) {
    return header.p_type == PT_LOAD && own - begin_of(header) < header.p_memsz;
  });
  if (is_own) return 0;
  for (const auto& header : headers) {
    if (header.p_type != PT_LOAD || (header.p_flags & PF_W) == 0) continue;
    const auto* const begin = reinterpret_cast<const std::byte*>(begin_of(header));
    static_cast<Search*>(search)->look_at(begin, begin + header.p_memsz);
  }
  return 0;
}

}  // namespace

std::vector<std::size_t> lost_blocks(World& world, const void* stack) {
  const auto blocks = ProgramHeap::blocks();
  if (std::all_of(blocks.begin(), blocks.end(),
                  [](const ProgramHeap::Block& block) { return block.is_freed; }))
    return {};
  Search search;
  for (std::size_t i = 0; i < ProgramImage::count(); ++i) {
    const auto variables = ProgramImage::variables(i);
    search.look_at(variables.data(), variables.data() + variables.size());
  }
  const Scheduler& scheduler = world.scheduler();
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    if (task.state == Task::State::finished) continue;
    const void* const begin = &task == scheduler.running() ? stack : task.context.stack_pointer();
    search.look_at(begin, task.storage->stack_top());
    search.look_at(reinterpret_cast<std::uintptr_t>(task.argument));  // of one that has not begun yet
    task.storage->visit_thread_locals([&](std::uintptr_t word) { search.look_at(word); });
  }
  std::vector<std::size_t> lost = search.lost();
  if (lost.empty()) return lost;  // mostly; the libraries have much more memory than the program
  dl_iterate_phdr(&look_at_library, &search);
  return search.lost();
}

}  // namespace ltsim
