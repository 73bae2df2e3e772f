#include "sim_clock/world/segments.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "sim_clock/check/own_descriptor.hpp"
#include "sim_clock/check/self_check.hpp"
#include "sim_clock/world/same_name.hpp"
#include "sim_clock/world/world.hpp"

// This file calls mmap(2) and its kind for the simulator itself: with current_task set they would be the
// simulated ones.
namespace ltsim {
namespace {

constexpr std::size_t page_bytes = 4096;

constexpr std::size_t page_end(std::size_t bytes) noexcept {
  return (bytes + page_bytes - 1) / page_bytes * page_bytes;
}

std::uint32_t offset_of(const volatile void* address) noexcept {
  return static_cast<std::uint32_t>((reinterpret_cast<std::uintptr_t>(address) - Segments::range_begin) &
                                    (Segments::segment_bytes_max - 1));
}

}  // namespace

Segments::Segments(World& world) : world_(world) {
  memory_ = as_own_descriptor(memfd_create("ltsim-segments", MFD_CLOEXEC));
  LTSIM_CHECK(memory_ >= 0);
  LTSIM_CHECK(ftruncate(memory_, static_cast<off_t>(segments_max << window_shift)) == 0);
  void* const all =
      mmap(nullptr, segments_max << window_shift, PROT_READ | PROT_WRITE, MAP_SHARED, memory_, 0);
  LTSIM_CHECK(all != MAP_FAILED);
  all_ = static_cast<std::byte*>(all);
  static const void* const range =
      mmap(reinterpret_cast<void*>(range_begin), range_bytes, PROT_NONE,
           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE, -1, 0);
  LTSIM_CHECK(range == reinterpret_cast<void*>(range_begin));
}

Segments::~Segments() {
  // The range stays reserved for the next world; what its windows showed is let go.
  void* const range = mmap(reinterpret_cast<void*>(range_begin), range_bytes, PROT_NONE,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED, -1, 0);
  LTSIM_CHECK(range == reinterpret_cast<void*>(range_begin));
  munmap(all_, segments_max << window_shift);
  ::close(memory_);
}

void Segments::reset() noexcept {
  for (std::size_t process = 0; process < world_.processes_count(); ++process) {
    const std::size_t first = process * segments_max * mappings_max;
    for (std::size_t i = 0; i < segments_count_ * mappings_max; ++i) windows_[first + i].mapped = false;
  }
  segments_count_ = 0;
  descriptors_.clear();
}

int Segments::open(std::string_view path, int flags) noexcept {
  const std::string_view name = path.substr(path.starts_with('/') ? 1 : 0);  // "/x" and "x" are one object
  Segment* segment = find(name);
  // A name under which there is a segment has been looked at before.
  if (segment == nullptr && (name.empty() || name.find('/') != std::string_view::npos)) {
    errno = EINVAL;
    return -1;
  }
  if (segment != nullptr && (flags & O_CREAT) != 0 && (flags & O_EXCL) != 0) {
    errno = EEXIST;
    return -1;
  }
  if (segment == nullptr && (flags & O_CREAT) == 0) {
    errno = ENOENT;
    return -1;
  }
  if (segment == nullptr) {
    segment = &create(name);
  } else if ((flags & O_TRUNC) != 0) {
    segment->bytes = 0;
  } else {
    world_.scheduler().only_looked();
  }
  descriptors_.push_back({.segment = index_of(*segment),
                          .process = current_task->process,
                          .open = true,
                          .writable = (flags & O_ACCMODE) != O_RDONLY});
  return first_descriptor + static_cast<int>(descriptors_.size() - 1);
}

void Segments::leave(std::string_view path, std::span<const std::byte> content) {
  const std::string_view name = path.substr(path.starts_with('/') ? 1 : 0);
  if (name.empty() || name.find('/') != std::string_view::npos || find(name) != nullptr ||
      segments_count_ == segments_max || content.size() > segment_bytes_max) {
    world_.unsupported(fmt::format("a segment \"{}\" of {} bytes cannot be left over", path, content.size()));
    return;
  }
  Segment& segment = create(name);
  grow(segment, content.size());
  std::byte* const bytes = all_ + (index_of(segment) << window_shift);
  std::memcpy(bytes, content.data(), content.size());
  world_.checks().accept_change(static_cast<SharedPlace>(bytes - all_), content.size());
}

Segments::Segment& Segments::create(std::string_view name) {
  if (segments_count_ == segments_max)
    world_.unsupported(fmt::format("more than {} shared memory objects in one execution", segments_max));
  Segment& segment = segments_[segments_count_++];
  if (!is_same_name(segment.name, name)) segment.name.assign(name);
  segment.object = world_.objects().add(name);
  segment.bytes = 0;
  segment.linked = true;
  return segment;
}

int Segments::unlink(std::string_view path) noexcept {
  Segment* const segment = find(path.substr(path.starts_with('/') ? 1 : 0));
  if (segment == nullptr) {
    errno = ENOENT;
    return -1;
  }
  segment->linked = false;
  return 0;
}

int Segments::resize(int descriptor, off_t bytes) noexcept {
  Segment* const segment = of_descriptor(descriptor);
  if (segment == nullptr) {
    errno = EBADF;
    return -1;
  }
  if (bytes < 0) {
    errno = EINVAL;
    return -1;
  }
  const auto wanted = static_cast<std::size_t>(bytes);
  if (wanted > segment_bytes_max) {
    world_.unsupported(fmt::format("a shared memory object of more than {} bytes", segment_bytes_max));
  }
  if (wanted == segment->bytes) {
    world_.scheduler().only_looked();
  } else if (wanted > segment->bytes) {
    grow(*segment, wanted);
  } else {
    segment->bytes = wanted;
  }
  return 0;
}

void Segments::grow(Segment& segment, std::size_t bytes) noexcept {
  // The rest of the last page, too, as far as it was used: it can be touched, and must not show what another execution left. To
  // fill it whole takes as long as two scheduling points.
  const std::size_t end = std::max(bytes, std::min(page_end(bytes), segment.used_bytes));
  const std::size_t begin = (index_of(segment) << window_shift) + segment.bytes;
  std::memset(all_ + begin, 0, end - segment.bytes);
  world_.checks().was_zeroed(static_cast<SharedPlace>(begin), end - segment.bytes);
  if (segment.used_bytes <= end) segment.used_bytes = bytes;
  segment.bytes = bytes;
}

int Segments::status(int descriptor, struct stat& into) noexcept {
  const Segment* const segment = of_descriptor(descriptor);
  if (segment == nullptr) {
    errno = EBADF;
    return -1;
  }
  // One by one: what compilers make of a fill of this size ("rep stos") takes longer to begin than all of this.
  into.st_dev = 0;
  into.st_ino = index_of(*segment) + 1;
  into.st_nlink = segment->linked ? 1 : 0;
  into.st_mode = S_IFREG | 0600;
  into.st_uid = 0;
  into.st_gid = 0;
  into.st_rdev = 0;
  into.st_size = static_cast<off_t>(segment->bytes);
  into.st_blksize = 4096;
  into.st_blocks = 0;
  into.st_atim = {};
  into.st_mtim = {};
  into.st_ctim = {};
  return 0;
}

int Segments::close(int descriptor) noexcept {
  Descriptor* const found = find_descriptor(descriptor);
  if (found == nullptr) {
    errno = EBADF;
    return -1;
  }
  found->open = false;
  return 0;
}

void* Segments::map(std::size_t bytes, int protection, int flags, int descriptor, off_t offset) noexcept {
  const Segment* const segment = of_descriptor(descriptor);
  if (segment == nullptr) {
    errno = EBADF;
    return MAP_FAILED;
  }
  const auto begin = static_cast<std::size_t>(offset);
  if (offset < 0 || begin % page_bytes != 0 || bytes == 0 || begin + bytes > segment_bytes_max) {
    errno = EINVAL;
    return MAP_FAILED;
  }
  const bool writable = (protection & PROT_WRITE) != 0;
  if (writable && !find_descriptor(descriptor)->writable) {
    errno = EACCES;
    return MAP_FAILED;
  }
  if ((flags & (MAP_PRIVATE | MAP_FIXED)) != 0) {
    world_.unsupported("mmap of a shared memory object with MAP_PRIVATE or MAP_FIXED");
  }
  return map_window(index_of(*segment), begin + bytes, writable) + begin;
}

std::byte* Segments::map_window(std::size_t segment, std::size_t bytes, bool writable) noexcept {
  const std::size_t first = (current_task->process * segments_max + segment) * mappings_max;
  for (std::size_t number = first; number < first + mappings_max; ++number) {
    Window& window = windows_[number];
    if (window.mapped) continue;
    auto* const address = reinterpret_cast<std::byte*>(range_begin + (number << window_shift));
    if (!window.has_memory) {
      const GhostScope ghost;
      void* const mapped = mmap(address, segment_bytes_max, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED,
                                memory_, static_cast<off_t>(segment << window_shift));
      LTSIM_CHECK(mapped == address);
      window.has_memory = true;
    }
    window.mapped = true;
    window.writable = writable;
    window.bytes = bytes;
    return address;
  }
  const GhostScope ghost;
  world_.unsupported(fmt::format("more than {} mappings of one segment in one process", mappings_max));
  return nullptr;
}

std::size_t Segments::create_unnamed(std::string_view name, std::size_t bytes) {
  if (bytes > segment_bytes_max)
    world_.unsupported(fmt::format("a shared memory object of more than {} bytes", segment_bytes_max));
  Segment& segment = create(name);
  segment.linked = false;
  grow(segment, bytes);
  return index_of(segment);
}

void* Segments::attach(std::size_t segment, std::size_t bytes, bool writable) noexcept {
  return map_window(segment, bytes, writable);
}

int Segments::detach(const void* address) noexcept {
  const std::size_t number = window_of(address);
  if (!contains(address) || offset_of(address) != 0 || !windows_[number].mapped ||
      process_of_window(number) != current_task->process) {
    errno = EINVAL;
    return -1;
  }
  windows_[number].mapped = false;
  return 0;
}

std::size_t Segments::mappings_of(std::size_t segment) const noexcept {
  std::size_t count = 0;
  for (std::size_t number = 0; number < windows_.size(); ++number)
    count += segment_of_window(number) == segment && windows_[number].mapped ? 1U : 0U;
  return count;
}

int Segments::unmap(void* address, std::size_t bytes) noexcept {
  const std::size_t number = window_of(address);
  Window& window = windows_[number];
  if (!window.mapped || process_of_window(number) != current_task->process) {
    errno = EINVAL;
    return -1;
  }
  if (page_end(bytes) < page_end(window.bytes) - offset_of(address)) {
    world_.unsupported("munmap of a part of a shared memory object");
  }
  window.mapped = false;
  return 0;
}

void Segments::process_died(ProcessId process) noexcept {
  constexpr std::size_t windows_of_a_process = segments_max * mappings_max;
  for (std::size_t i = 0; i < windows_of_a_process; ++i)
    windows_[process * windows_of_a_process + i].mapped = false;
  for (Descriptor& descriptor : descriptors_) {
    if (descriptor.process == process) descriptor.open = false;
  }
}

Operation Segments::arrive(const volatile void* address, std::size_t bytes, OperationKind kind,
                           std::uint32_t site) noexcept {
  const Place place = locate(address, bytes, kind);
  return {.kind = kind,
          .bytes = static_cast<std::uint8_t>(bytes),
          .object = place.object,
          .offset = place.offset,
          .site = site};
}

void Segments::go_on(const volatile void* address, const Operation& operation, bool others_ran) noexcept {
  const std::size_t bytes = operation.bytes;
  const OperationKind kind = operation.kind;
  if (others_ran) static_cast<void>(locate(address, bytes, kind));
  if (world_.damages().are_possible()) [[unlikely]] {
    const std::size_t index = segment_of_window(window_of(address));
    world_.damages().choose(segments_[index].name, {all_ + (index << window_shift), segments_[index].bytes});
  }

  if (kind == OperationKind::write) world_.weak_memory().written_plainly(address, bytes);
  MemoryChecks& checks = world_.checks();
  if (!checks.on()) return;
  const SharedPlace shared_place = place_of(address);
  const bool writes = changes_memory(kind);
  if (!checks.before_access(shared_place, bytes, writes)) [[unlikely]] {
    const SharedPlace begin = shared_place & ~7U;
    changed_unseen(checks.find_unseen_change(begin, (shared_place - begin + bytes + 7) & ~std::size_t{7})
                       .value_or(shared_place),
                   fmt::format("{} noticed it at its next access", current_task->name));
  }
  if (kind == OperationKind::read || kind == OperationKind::write) {
    checks.accessed({.task = current_task->id,
                     .place = shared_place,
                     .bytes = operation.bytes,
                     .writes = writes,
                     .plain = true,
                     .site = operation.site},
                    !writes);
  }
}

void Segments::announce_write(const volatile void* address, std::size_t bytes) noexcept {
  world_.checks().announce_write(place_of(address), bytes);
}

void Segments::accept_change(const volatile void* address, std::size_t bytes) noexcept {
  if (!contains(address)) return;
  Segment& segment = segments_[segment_of_window(window_of(address))];
  segment.used_bytes = std::max(segment.used_bytes, offset_of(address) + bytes);
  world_.checks().accept_change(place_of(address), bytes);
}

void Segments::accept_change(ObjectId segment, std::uint32_t offset, std::size_t bytes) noexcept {
  for (std::size_t i = 0; i < segments_count_; ++i) {
    if (segments_[i].object != segment) continue;
    world_.checks().accept_change(static_cast<SharedPlace>(i << window_shift) + offset, bytes);
  }
}

void Segments::check_all_memory() {
  for (std::size_t i = 0; i < segments_count_; ++i) {
    const auto begin = static_cast<SharedPlace>(i << window_shift);
    const auto change = world_.checks().find_unseen_change(begin, page_end(segments_[i].bytes));
    if (change) return changed_unseen(*change, "it was noticed at the end");
  }
}

void Segments::changed_unseen(SharedPlace place, std::string_view noticed) {
  world_.unsupported(fmt::format(
      "byte {} of segment {} changed without an access that ltsim saw ({}): by inline assembly, or "
      "by code that is not compiled with ltsim_instrument(). Scheduling points are missing there, "
      "and a pass would mean nothing",
      offset_in_segment(place), world_.objects().object_name(segment_at(place)), noticed));
}

Segments::Place Segments::locate(const volatile void* address, std::size_t bytes,
                                 OperationKind kind) noexcept {
  const std::size_t number = window_of(address);
  Segment& segment = segments_[segment_of_window(number)];
  const std::uint32_t offset = offset_of(address);
  const Window& window = windows_[number];
  // Linux maps whole pages: bytes between the end of the object and the end of its last page can be touched.
  const std::size_t pages_end = page_end(std::min(window.bytes, segment.bytes));
  const bool is_mapped = window.mapped && process_of_window(number) == current_task->process;
  if (!is_mapped || offset >= pages_end || (changes_memory(kind) && !window.writable)) [[unlikely]] {
    const GhostScope ghost;
    world_.scheduler().fail(
        OutcomeKind::crash,
        fmt::format("access to byte {} of segment {}, which is not mapped there (SIGSEGV or SIGBUS)", offset,
                    world_.objects().object_name(segment.object)));
  }
  if (offset + bytes > segment.bytes) [[unlikely]]
    segment.used_bytes = std::max(segment.used_bytes, offset + bytes);
  return {.object = segment.object, .offset = offset};
}

std::uint64_t Segments::value_at(const Operation& operation) const noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < segments_count_; ++i) {
    if (segments_[i].object != operation.object) continue;
    std::memcpy(&value, all_ + (i << window_shift) + operation.offset,
                std::min<std::size_t>(operation.bytes, sizeof value));
  }
  return value;
}

Segments::Segment* Segments::find(std::string_view name) noexcept {
  for (std::size_t i = 0; i < segments_count_; ++i) {
    if (segments_[i].linked && is_same_name(segments_[i].name, name)) return &segments_[i];
  }
  return nullptr;
}

Segments::Descriptor* Segments::find_descriptor(int descriptor) noexcept {
  const auto index = static_cast<std::size_t>(descriptor - first_descriptor);
  if (!is_descriptor(descriptor) || index >= descriptors_.size() || !descriptors_[index].open) return nullptr;
  return &descriptors_[index];
}

Segments::Segment* Segments::of_descriptor(int descriptor) noexcept {
  const Descriptor* const found = find_descriptor(descriptor);
  return found == nullptr ? nullptr : &segments_[found->segment];
}

void Segments::add_state(StateHash& hash) const noexcept {
  hash.add(segments_count_);
  for (std::size_t i = 0; i < segments_count_; ++i) {
    const Segment& segment = segments_[i];
    hash.add(std::uint64_t{segment.bytes} << 1U | std::uint64_t{segment.linked});
    hash.add_memory(all_ + (i << window_shift), segment.used_bytes);
  }
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    const Window& window = windows_[i];
    if (window.mapped)
      hash.add(i << 33U | std::uint64_t{window.bytes} << 1U | std::uint64_t{window.writable});
  }
  for (std::size_t i = 0; i < descriptors_.size(); ++i) {
    const Descriptor& descriptor = descriptors_[i];
    if (!descriptor.open) continue;
    hash.add(i << 32U | std::uint64_t{descriptor.segment} << 16U | std::uint64_t{descriptor.process} << 2U |
             std::uint64_t{descriptor.open} << 1U | std::uint64_t{descriptor.writable});
  }
}

}  // namespace ltsim
