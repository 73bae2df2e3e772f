// Where the code under test lies in memory, and its variables: the program that was started, or the images that were loaded to
// be the processes of one world. Libraries that they load are none of it.
//
// An image begins at another address in each run, so places are counted from where it begins; those of a second image go on
// where those of the first end.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sim_clock/world/task.hpp"

struct dl_phdr_info;

namespace ltsim {

class ProgramImage {
 public:
  /// What each has that is not in the hot path.
  struct File {
    const char* path;  ///< with its symbols and debug information
    std::uintptr_t loaded_at;
  };

  /// @param return_address  of a call made by the code
  /// @return  its place, from 1; 0 for code of a shared library, whose place differs from run to run
  [[nodiscard]] static std::uint32_t site_of(const void* return_address) noexcept {
    for (const Image& image : images()) {
      const std::uintptr_t offset = reinterpret_cast<std::uintptr_t>(return_address) - image.begin;
      if (offset < image.code_bytes) return image.sites_begin + static_cast<std::uint32_t>(offset);
    }
    return 0;
  }

  [[nodiscard]] static bool contains(const void* address) noexcept {
    const auto all = images();
    return std::any_of(all.begin(), all.end(), [&](const Image& image) {
      return reinterpret_cast<std::uintptr_t>(address) - image.begin < image.bytes;
    });
  }

  [[nodiscard]] static std::size_t count() noexcept { return count_; }
  /// @param address  one that an image contains
  [[nodiscard]] static std::size_t image_of(const void* address) noexcept {
    std::size_t index = 0;
    while (index + 1 < count_ &&
           reinterpret_cast<std::uintptr_t>(address) - images_[index].begin >= images_[index].bytes)
      ++index;
    return index;
  }
  [[nodiscard]] static const File& file(std::size_t index) noexcept { return files_[index]; }

  struct Site {
    std::size_t image = 0;
    /// Where the image's headers say that it is: what debug information counts in.
    std::uintptr_t linked_address = 0;
  };
  /// @param site  from site_of(), not 0
  [[nodiscard]] static Site find_site(std::uint32_t site) noexcept;

  /// Those of one image that can change while the program runs.
  [[nodiscard]] static std::span<std::byte> variables(std::size_t index) noexcept {
    const Image& image = images_[index];
    return {reinterpret_cast<std::byte*>(image.variables_begin), image.variables_bytes};
  }
  /// Where the variables of an image begin among those of all.
  [[nodiscard]] static std::uint32_t first_variable(std::size_t index) noexcept {
    return images_[index].first_variable;
  }
  /// Of all images.
  [[nodiscard]] static std::size_t variables_bytes() noexcept {
    return count_ == 0 ? 0 : images_[count_ - 1].first_variable + images_[count_ - 1].variables_bytes;
  }

  static constexpr std::uint32_t no_variable = ~std::uint32_t{0};
  /// @return  the byte's place among the variables of all images; no_variable: it is none
  [[nodiscard]] static std::uint32_t variable_at(const volatile void* address) noexcept {
    for (const Image& image : images()) {
      const std::uintptr_t offset = reinterpret_cast<std::uintptr_t>(address) - image.variables_begin;
      if (offset < image.variables_bytes) return image.first_variable + static_cast<std::uint32_t>(offset);
    }
    return no_variable;
  }
  /// Which image's the variable is.
  /// @param place  less than variables_bytes()
  [[nodiscard]] static std::size_t image_of_variable(std::uint32_t place) noexcept;

  /// Adds what was started; until then no address lies in an image. Before anything of the program runs.
  static void add_program();
  /// From here on no image is known: what was started is not the code under test.
  static void forget_program() noexcept { count_ = 0; }
  /// An image of that file will be loaded next: it is added when code of it begins to run.
  /// @param path  lives as long as the program
  static void expect(const char* path) noexcept { expected_ = path; }
  /// Code that was compiled to be looked into runs for the first time.
  /// @param inside  an address in its image
  static void begins(const void* inside) {
    if (expected_ != nullptr && !contains(inside)) add_expected(inside);
  }

  static constexpr std::size_t images_max = processes_max;

 private:
  struct Image {
    std::uintptr_t begin;
    std::uintptr_t bytes;
    std::uintptr_t code_bytes;
    std::uintptr_t variables_begin;
    std::size_t variables_bytes;
    std::uint32_t sites_begin;
    std::uint32_t first_variable;
  };

  [[nodiscard]] static std::span<const Image> images() noexcept { return {images_.data(), count_}; }
  static void add_expected(const void* inside);
  static void add(const dl_phdr_info& module, const char* path);

  static inline std::array<Image, images_max> images_{};
  static inline std::array<File, images_max> files_{};
  static inline std::size_t count_ = 0;
  static inline const char* expected_ = nullptr;  // the path
};

}  // namespace ltsim
