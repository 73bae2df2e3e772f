#include "tests/house/include_rules.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string_view>

namespace house {

namespace {

namespace fs = std::filesystem;

struct Rule {
  std::string_view folder;
  std::vector<std::string_view> never;
};

const std::array<Rule, 4>& rules() {
  static const std::array<Rule, 4> all{{
      {"sim_clock", {"protocol", "emulator_models", "kernel_mocks", "tests", "property_tests", "fuzz"}},
      {"protocol", {"sim_clock", "emulator_models", "kernel_mocks", "tests", "property_tests", "fuzz"}},
      {"emulator_models", {"sim_clock", "kernel_mocks", "tests", "property_tests", "fuzz"}},
      {"kernel_mocks", {"sim_clock", "emulator_models", "tests", "property_tests", "fuzz"}},
  }};
  return all;
}

bool is_source(const fs::path& file) {
  static const std::array<std::string_view, 9> extensions{".cpp", ".hpp", ".c",   ".h",  ".cc",
                                                          ".cxx", ".hxx", ".inl", ".ipp"};
  return std::ranges::find(extensions, file.extension().string()) != extensions.end();
}

void skip_blanks(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

bool skip(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

/// @return what stands between the quotes or angle brackets of an include directive
std::optional<std::string_view> included_path(std::string_view line) {
  skip_blanks(line);
  if (!skip(line, "#")) return std::nullopt;
  skip_blanks(line);
  if (!skip(line, "include")) return std::nullopt;
  skip(line, "_next");
  skip_blanks(line);
  if (line.empty() || (line.front() != '"' && line.front() != '<')) return std::nullopt;
  const char closing = line.front() == '"' ? '"' : '>';
  line.remove_prefix(1);
  return line.substr(0, line.find(closing));
}

/// @return the top-level folder in which `path` lies; nothing outside the root
std::optional<std::string> top_folder(const fs::path& root, const fs::path& path) {
  const fs::path relative = path.lexically_normal().lexically_relative(root);
  if (relative.empty() || *relative.begin() == "..") return std::nullopt;
  return relative.begin()->string();
}

std::optional<std::string> broken_never(const fs::path& root, const fs::path& file, const Rule& rule,
                                        std::string_view included) {
  for (const fs::path& start : {root, file.parent_path()}) {
    const auto folder = top_folder(root, start / included);
    if (folder && std::ranges::find(rule.never, *folder) != rule.never.end()) return folder;
  }
  return std::nullopt;
}

void check_file(const fs::path& root, const fs::path& file, const Rule& rule,
                std::vector<ForbiddenInclude>& found) {
  std::ifstream text(file);
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    const auto included = included_path(line);
    if (!included) continue;
    if (auto folder = broken_never(root, file, rule, *included))
      found.push_back({.file = file.lexically_relative(root), .line = number, .folder = std::move(*folder)});
  }
}

}  // namespace

std::string to_string(const ForbiddenInclude& found) {
  return found.file.string() + ":" + std::to_string(found.line) + ": includes " + found.folder;
}

std::vector<ForbiddenInclude> forbidden_includes(const fs::path& given_root) {
  const fs::path root = fs::absolute(given_root).lexically_normal();
  std::vector<ForbiddenInclude> found;
  for (const Rule& rule : rules()) {
    const fs::path folder = root / rule.folder;
    if (!fs::exists(folder)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file() && is_source(entry.path())) check_file(root, entry.path(), rule, found);
  }
  std::ranges::sort(found, {}, [](const ForbiddenInclude& each) { return std::pair(each.file, each.line); });
  return found;
}

}  // namespace house
