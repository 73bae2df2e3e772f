// Memory that a process shares with those that it forks: what one of them writes there, all see.
#pragma once

#include <cstddef>
#include <span>

namespace ltsim {

/// Zeros at first; processes that are forked meanwhile see the same bytes. Takes room with use.
/// @throw std::system_error when there is no memory
[[nodiscard]] void* new_shared_memory(std::size_t bytes);
void delete_shared_memory(void* memory, std::size_t bytes) noexcept;

class SharedMemory {
 public:
  explicit SharedMemory(std::size_t bytes)
      : bytes_{static_cast<std::byte*>(new_shared_memory(bytes)), bytes} {}
  ~SharedMemory() { delete_shared_memory(bytes_.data(), bytes_.size()); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  [[nodiscard]] std::span<std::byte> bytes() const noexcept { return bytes_; }

 private:
  std::span<std::byte> bytes_;
};

}  // namespace ltsim
