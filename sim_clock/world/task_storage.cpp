#include "sim_clock/world/task_storage.hpp"

#include <elf.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/world/state_hash.hpp"
#include "sim_clock/world/thread_pointer.hpp"

// Exported by glibc for its own parts (GLIBC_PRIVATE) and used by debuggers and sanitizers too: the
// allocation of a new thread's static TLS block, and the first use of <ctype.h> in a new thread.
extern "C" void* _dl_allocate_tls(void* memory);
extern "C" void _dl_deallocate_tls(void* thread_pointer, bool free_block);
extern "C" void __ctype_init();

namespace ltsim {
namespace {

/// Bytes of a thread-local, as they are in every thread at a fixed distance from the thread pointer, and their initial value.
template <typename Piece>
struct ThreadLocal {
  std::ptrdiff_t from_thread_pointer;
  Piece initial_value;
};

/// Thread-locals of all modules but libc. The usual program and its libraries have a dozen words of them: storing those
/// takes a third of the time that a copy and a fill for each module would.
struct ThreadLocals {
  std::vector<ThreadLocal<std::uint64_t>> words;
  std::vector<ThreadLocal<std::uint8_t>> bytes;  // at the end of a module's, what is no whole word
};

bool belongs_to_libc(std::string_view path) noexcept {
  const std::string_view file = path.substr(path.find_last_of('/') + 1);
  return file.starts_with("libc.so") || file.starts_with("libc-") || file.starts_with("ld-linux");
}

int collect(dl_phdr_info* module, std::size_t /*size*/, void* into) {
  if (module->dlpi_tls_data == nullptr || belongs_to_libc(module->dlpi_name)) return 0;
  for (int i = 0; i < module->dlpi_phnum; ++i) {
    const auto& header = module->dlpi_phdr[i];
    if (header.p_type != PT_TLS) continue;
    const std::ptrdiff_t begin =
        static_cast<char*>(module->dlpi_tls_data) - static_cast<char*>(current_thread_pointer());
    std::vector<unsigned char> image(header.p_memsz, 0);
    std::copy_n(reinterpret_cast<const unsigned char*>(module->dlpi_addr + header.p_vaddr), header.p_filesz,
                image.begin());
    auto& all = *static_cast<ThreadLocals*>(into);
    std::size_t at = 0;
    for (; at + sizeof(std::uint64_t) <= image.size(); at += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, &image[at], sizeof word);
      all.words.push_back({begin + static_cast<std::ptrdiff_t>(at), word});
    }
    for (; at < image.size(); ++at) all.bytes.push_back({begin + static_cast<std::ptrdiff_t>(at), image[at]});
  }
  return 0;
}

/// Of the modules that lie in static TLS, that is all that were loaded with the program.
const ThreadLocals& thread_locals_to_reset() {
  static const ThreadLocals all = [] {
    ThreadLocals found;
    dl_iterate_phdr(&collect, &found);
    return found;
  }();
  return all;
}

std::ptrdiff_t errno_from_thread_pointer() noexcept {
  return reinterpret_cast<char*>(&errno) - static_cast<char*>(current_thread_pointer());
}

/// Of all tasks of all worlds; a scenario may hold a thread of a task longer than the execution lasts.
std::vector<const void*>& thread_pointers_of_tasks() {
  static std::vector<const void*> all;
  return all;
}

// Words of glibc's thread control block that a new thread inherits: x86-64, glibc sysdeps/x86_64/nptl/tls.h,
// tcbhead_t.
constexpr std::size_t self_tcb = 0;
constexpr std::size_t self_thread = 16;
constexpr std::size_t stack_guard = 40;
constexpr std::size_t pointer_guard = 48;

/// Which slots hold a stack.
std::array<bool, TaskStorage::slots_count> slots_taken{};

constexpr std::size_t slot_bytes = std::size_t{1} << TaskStorage::slot_shift;

void* take_slot() {
  static const void* const range =
      mmap(reinterpret_cast<void*>(TaskStorage::range_begin), TaskStorage::range_bytes, PROT_NONE,
           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE, -1, 0);
  LTSIM_CHECK(range == reinterpret_cast<void*>(TaskStorage::range_begin));
  const auto slot = std::find(slots_taken.begin(), slots_taken.end(), false);
  LTSIM_CHECK(slot != slots_taken.end());
  *slot = true;
  return reinterpret_cast<void*>(TaskStorage::range_begin +
                                 static_cast<std::size_t>(slot - slots_taken.begin()) * slot_bytes);
}

}  // namespace

TaskStorage::TaskStorage() {
  stack_base_ = take_slot();
  stack_top_ = static_cast<char*>(stack_base_) + slot_bytes;
  LTSIM_CHECK(mprotect(static_cast<char*>(stack_top_) - stack_bytes, stack_bytes, PROT_READ | PROT_WRITE) ==
              0);

  thread_pointer_ = _dl_allocate_tls(nullptr);
  LTSIM_CHECK(thread_pointer_ != nullptr);
  char* const block = static_cast<char*>(thread_pointer_);
  const char* const own = static_cast<const char*>(current_thread_pointer());
  std::memcpy(block + self_tcb, &thread_pointer_, sizeof thread_pointer_);
  std::memcpy(block + self_thread, &thread_pointer_, sizeof thread_pointer_);
  std::memcpy(block + stack_guard, own + stack_guard, sizeof(std::uintptr_t));
  std::memcpy(block + pointer_guard, own + pointer_guard, sizeof(std::uintptr_t));
  thread_pointers_of_tasks().push_back(thread_pointer_);
}

TaskStorage::~TaskStorage() {
  std::erase(thread_pointers_of_tasks(), thread_pointer_);
  _dl_deallocate_tls(thread_pointer_, true);
  // The slot stays reserved for the next one; what was on the stack is let go.
  LTSIM_CHECK(mmap(stack_base_, slot_bytes, PROT_NONE,
                   MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED, -1, 0) == stack_base_);
  slots_taken[slot()] = false;
}

void TaskStorage::reset() noexcept {
  char* const base = static_cast<char*>(thread_pointer_);
  const ThreadLocals& all = thread_locals_to_reset();
  for (const auto& [from_thread_pointer, initial_value] : all.words)
    std::memcpy(base + from_thread_pointer, &initial_value, sizeof initial_value);
  for (const auto& [from_thread_pointer, initial_value] : all.bytes)
    std::memcpy(base + from_thread_pointer, &initial_value, sizeof initial_value);
  std::memset(base + errno_from_thread_pointer(), 0, sizeof errno);
}

const std::vector<std::ptrdiff_t>& TaskStorage::thread_local_words() {
  static const std::vector<std::ptrdiff_t> all = [] {
    std::vector<std::ptrdiff_t> places;
    for (const auto& local : thread_locals_to_reset().words) places.push_back(local.from_thread_pointer);
    return places;
  }();
  return all;
}

void TaskStorage::add_state(StateHash& hash) const noexcept {
  const char* const base = static_cast<const char*>(thread_pointer_);
  const ThreadLocals& all = thread_locals_to_reset();
  for (const auto& local : all.words)
    hash.add_memory(base + local.from_thread_pointer, sizeof(std::uint64_t));
  for (const auto& local : all.bytes) hash.add_memory(base + local.from_thread_pointer, 1);
  hash.add_memory(base + errno_from_thread_pointer(), sizeof errno);
}

void TaskStorage::clean_stack_below(void* stack_pointer, std::size_t bytes_max) const noexcept {
  constexpr std::size_t red_zone_bytes =
      128;  // System V ABI for x86-64, 3.2.2: in use, below the stack pointer
  char* const end = static_cast<char*>(stack_pointer) - red_zone_bytes;
  char* const lowest = static_cast<char*>(stack_top_) - stack_bytes;
  char* const begin = end - lowest > static_cast<std::ptrdiff_t>(bytes_max) ? end - bytes_max : lowest;
  if (begin < end) std::memset(begin, 0, static_cast<std::size_t>(end - begin));
}

bool TaskStorage::contains(std::uintptr_t address) const noexcept {
  const auto number_of = [](const void* of) { return reinterpret_cast<std::uintptr_t>(of); };
  if (address >= number_of(stack_base_) && address < number_of(stack_top_)) return true;
  const std::uintptr_t base = number_of(thread_pointer_);
  if (address == base + static_cast<std::uintptr_t>(errno_from_thread_pointer())) return true;
  const ThreadLocals& all = thread_locals_to_reset();
  const auto is_of = [&](const auto& local) {
    return address - (base + static_cast<std::uintptr_t>(local.from_thread_pointer)) <
           sizeof(local.initial_value);
  };
  return std::any_of(all.words.begin(), all.words.end(), is_of) ||
         std::any_of(all.bytes.begin(), all.bytes.end(), is_of);
}

bool TaskStorage::is_of_a_task(const void* thread_pointer) noexcept {
  const auto& all = thread_pointers_of_tasks();
  return std::find(all.begin(), all.end(), thread_pointer) != all.end();
}

bool TaskStorage::on_guard(const void* address) const noexcept {
  const auto* const at = static_cast<const char*>(address);
  const auto* const base = static_cast<const char*>(stack_base_);
  return at >= base && at < static_cast<const char*>(stack_top_) - stack_bytes;
}

void TaskStorage::finish_set_up_of_current() noexcept { __ctype_init(); }

}  // namespace ltsim
