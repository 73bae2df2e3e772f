// Where the program lies in memory: the code under test, and its variables.
//
// The program is what was started, not a library that it loads: its image begins at another address in each run, so places in it
// are counted from there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ltsim {

class ProgramImage {
 public:
  /// @param return_address  of a call made by the code
  /// @return  bytes from the image's begin; 0 for code of a shared library, whose place differs from run to run
  [[nodiscard]] static std::uint32_t site_of(const void* return_address) noexcept {
    const std::uintptr_t site = reinterpret_cast<std::uintptr_t>(return_address) - begin_;
    return site < code_bytes_ ? static_cast<std::uint32_t>(site) : 0;
  }

  [[nodiscard]] static bool contains(const void* address) noexcept {
    return reinterpret_cast<std::uintptr_t>(address) - begin_ < bytes_;
  }

  /// Where the program's headers say that the site is: what debug information and symbols count in.
  [[nodiscard]] static std::uintptr_t linked_address_of(std::uint32_t site) noexcept {
    return begin_ + site - loaded_at_;
  }
  [[nodiscard]] static std::uintptr_t loaded_at() noexcept { return loaded_at_; }

  /// Those that can change while the program runs.
  [[nodiscard]] static std::span<std::byte> variables() noexcept {
    return {reinterpret_cast<std::byte*>(variables_begin_), variables_bytes_};
  }

  /// Looks them up; until then no address lies in the image. Before anything of the program runs.
  static void find() noexcept;

 private:
  static inline std::uintptr_t begin_ = 0;
  static inline std::uintptr_t bytes_ = 0;
  static inline std::uintptr_t code_bytes_ = 0;
  static inline std::uintptr_t loaded_at_ = 0;
  static inline std::uintptr_t variables_begin_ = 0;
  static inline std::size_t variables_bytes_ = 0;
};

}  // namespace ltsim
