#include "sim_clock/program/launch.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/personality.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "sim_clock/world/object_names.hpp"

namespace ltsim {
namespace {

constexpr const char* variable = "LTSIM_COMMAND";
constexpr char separator = '\x1f';
constexpr const char* binding_variable =
    "LD_BIND_NOW";  // of the dynamic linker, which asks whether it is set
constexpr const char* bound_by_us = "ltsim";

/// Why the file is no program of ltsim-c++; empty: it is one.
std::string what_is_wrong_with(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return fmt::format("{}: {}", path, strerror(errno));
  struct stat status{};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0) {
    close(file);
    return fmt::format("{}: is no program", path);
  }
  const auto bytes = static_cast<std::size_t>(status.st_size);
  void* const content = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file, 0);
  close(file);
  if (content == MAP_FAILED) return fmt::format("{}: {}", path, strerror(errno));
  const std::string_view text{static_cast<const char*>(content), bytes};
  const bool is_program = text.starts_with(
      "\x7f"
      "ELF");
  // In the table of the libraries that it needs.
  const bool needs_us = text.find(std::string_view{"\0libltsim.so\0", 13}) != std::string_view::npos;
  munmap(content, bytes);
  if (!is_program) return fmt::format("{}: is no program: a script cannot be looked into", path);
  if (!needs_us) return fmt::format("{}: was not built with ltsim-cc or ltsim-c++", path);
  return {};
}

}  // namespace

std::string scenario_name_of(const std::string& program_path) {
  std::string name = std::filesystem::path{program_path}.filename().string();
  make_one_word(name);
  return name;
}

std::string launch_program(const std::vector<std::string>& command, const std::vector<std::string>& program) {
  if (std::string wrong = what_is_wrong_with(program.front()); !wrong.empty()) return wrong;
  std::string joined;
  for (const std::string& word : command) joined += word + separator;
  setenv(variable, joined.c_str(), 1);
  // Addresses that are the same in each run: what depends on their order does not differ then.
  personality(static_cast<unsigned long>(personality(0xffffffff)) | ADDR_NO_RANDOMIZE);
  // Functions of libraries are bound once, and not in each process that is forked.
  if (getenv(binding_variable) == nullptr) setenv(binding_variable, bound_by_us, 1);
  std::vector<char*> arguments;
  for (const std::string& word : program) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(program.front().c_str(), arguments.data());
  return fmt::format("{}: {}", program.front(), strerror(errno));
}

std::optional<std::vector<std::string>> take_launch_command() {
  const char* const joined = getenv(variable);
  if (joined == nullptr) return std::nullopt;
  std::vector<std::string> command;
  for (std::string_view rest = joined; !rest.empty();) {
    const std::size_t end = rest.find(separator);
    command.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  unsetenv(variable);
  if (const char* const by = getenv(binding_variable); by != nullptr && std::string_view{by} == bound_by_us)
    unsetenv(binding_variable);
  return command;
}

}  // namespace ltsim
