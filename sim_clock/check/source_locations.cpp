#include "sim_clock/check/source_locations.hpp"

#include <dwarf.h>
#include <elfutils/libdw.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/check/own_descriptor.hpp"
#include "sim_clock/world/program_image.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {
namespace {

struct Line {
  std::string_view file;
  int number = 0;
};

bool is_of_the_code_under_test(std::string_view file) noexcept {
  return !file.empty() && !file.starts_with("/usr/") && file.find("/boost/") == std::string_view::npos;
}

/// The debug information of one image, read once and kept.
class DebugInformation {
 public:
  explicit DebugInformation(std::size_t image)
      : file_(as_own_descriptor(open(ProgramImage::file(image).path, O_RDONLY | O_CLOEXEC))) {
    if (file_ >= 0) dwarf_ = dwarf_begin(file_, DWARF_C_READ);
  }

  [[nodiscard]] std::string location(std::uintptr_t return_address) const {
    const Dwarf_Addr address = return_address - 1;  // the call stands before it
    Dwarf_Die unit;
    if (dwarf_ == nullptr || !find_unit(address, unit)) return {};
    const Line line = innermost_line_under_test(unit, address);
    if (line.file.empty()) return {};
    return fmt::format("{}:{}", shortened(line.file, unit), line.number);
  }

 private:
  /// Without .debug_aranges, which clang does not write: unit by unit.
  [[nodiscard]] bool find_unit(Dwarf_Addr address, Dwarf_Die& unit) const {
    Dwarf_CU* each = nullptr;
    Dwarf_Die none;
    std::uint8_t kind = 0;
    while (dwarf_get_units(dwarf_, each, &each, nullptr, &kind, &unit, &none) == 0) {
      if (kind == DW_UT_compile && dwarf_haspc(&unit, address) == 1) return true;
    }
    return false;
  }

  static Line innermost_line_under_test(Dwarf_Die& unit, Dwarf_Addr address) {
    Line line = line_at(unit, address);
    const Line innermost = line;
    Dwarf_Die* found = nullptr;
    const int count = dwarf_getscopes(&unit, address, &found);
    const std::unique_ptr<Dwarf_Die, decltype(&std::free)> scopes{found, &std::free};
    for (int i = 0; i < count && !is_of_the_code_under_test(line.file); ++i) {
      if (dwarf_tag(&found[i]) == DW_TAG_inlined_subroutine) line = line_of_call(unit, found[i]);
    }
    return is_of_the_code_under_test(line.file) ? line : innermost;
  }

  static Line line_at(Dwarf_Die& unit, Dwarf_Addr address) {
    Dwarf_Line* const line = dwarf_getsrc_die(&unit, address);
    if (line == nullptr) return {};
    const char* const file = dwarf_linesrc(line, nullptr, nullptr);
    int number = 0;
    if (file == nullptr || dwarf_lineno(line, &number) != 0) return {};
    return {.file = file, .number = number};
  }

  static Line line_of_call(Dwarf_Die& unit, Dwarf_Die& inlined) {
    Dwarf_Files* files = nullptr;
    std::size_t count = 0;
    const Dwarf_Word file = number_of(inlined, DW_AT_call_file);
    if (dwarf_getsrcfiles(&unit, &files, &count) != 0 || file >= count) return {};
    const char* const name = dwarf_filesrc(files, file, nullptr, nullptr);
    if (name == nullptr) return {};
    return {.file = name, .number = static_cast<int>(number_of(inlined, DW_AT_call_line))};
  }

  static Dwarf_Word number_of(Dwarf_Die& die, unsigned name) {
    Dwarf_Attribute attribute;
    Dwarf_Word number = 0;
    dwarf_formudata(dwarf_attr(&die, name, &attribute), &number);
    return number;
  }

  /// Without what the file's path and the folder of the compilation have in common: the project's root, for
  /// builds that lie in it.
  static std::string shortened(std::string_view path, Dwarf_Die& unit) {
    Dwarf_Attribute attribute;
    const char* const text = dwarf_formstring(dwarf_attr(&unit, DW_AT_comp_dir, &attribute));
    const std::string folder = std::string{text == nullptr ? "" : text} + "/";
    const std::string file = (std::filesystem::path{folder} / path).lexically_normal().string();
    std::size_t common = 0;
    for (std::size_t i = 0; i < file.size() && i < folder.size() && file[i] == folder[i]; ++i) {
      if (file[i] == '/') common = i + 1;
    }
    return common > 1 ? file.substr(common) : file;
  }

  int file_;
  Dwarf* dwarf_ = nullptr;
};

std::vector<std::uint32_t>& looked_up() noexcept {
  static std::vector<std::uint32_t> sites;
  return sites;
}

}  // namespace

const std::string& source_location(std::uint32_t site) {
  static std::unordered_map<std::uint32_t, std::string> known;
  const auto [entry, is_new] = known.try_emplace(site);
  if (!is_new || site == 0) return entry->second;
  const GhostScope ghost;
  static std::array<std::unique_ptr<DebugInformation>, ProgramImage::images_max> information;
  const auto [image, linked_address] = ProgramImage::find_site(site);
  if (information[image] == nullptr) information[image] = std::make_unique<DebugInformation>(image);
  entry->second = information[image]->location(linked_address);
  looked_up().push_back(site);
  return entry->second;
}

std::span<const std::uint32_t> sites_looked_up() noexcept { return looked_up(); }

}  // namespace ltsim
