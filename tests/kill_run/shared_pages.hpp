// Memory that a process shares with those that it forks, and that outlives each of them: it has no name and goes with
// the last process that maps it.
#pragma once

#include <cstddef>

namespace kill_run {

class SharedPages {
 public:
  /// All zeros. Pages that nobody touches cost nothing.
  /// @throw std::system_error  the system has no room for it
  explicit SharedPages(std::size_t size_bytes);
  SharedPages(const SharedPages&) = delete;
  SharedPages& operator=(const SharedPages&) = delete;
  ~SharedPages();

  [[nodiscard]] void* address() const noexcept { return address_; }

 private:
  std::size_t size_bytes_;
  void* address_;
};

}  // namespace kill_run
