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

#include "sim_clock/program/process_options.hpp"
#include "sim_clock/world/object_names.hpp"

namespace ltsim {
namespace {

/// Of the environment: the command.
const char* variable_of(LaunchedProgram program) noexcept {
  return program == LaunchedProgram::whole ? "LTSIM_COMMAND" : "LTSIM_PROCESSES_COMMAND";
}

/// It lies beside the program that runs now.
std::string path_of_processes_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).replace_filename(processes_program).string();
}

/// Of images, which are loaded later: glibc keeps little room for those.
void make_room_for_thread_locals() {
  constexpr const char* variable = "GLIBC_TUNABLES";
  const char* const before = getenv(variable);
  const std::string room = "glibc.rtld.optional_static_tls=65536";
  setenv(variable, before == nullptr ? room.c_str() : (std::string{before} + ":" + room).c_str(), 1);
}

constexpr char separator = '\x1f';
constexpr const char* binding_variable =
    "LD_BIND_NOW";  // of the dynamic linker, which asks whether it is set
constexpr const char* bound_by_us = "ltsim";

/// Why the file is no program of ltsim-c++; empty: it is one.
/// @param is_image  it is to be loaded by another one
std::string what_is_wrong_with(const std::string& path, bool is_image) {
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
  if (!needs_us)
    return fmt::format("{}: was not built with ltsim-cc or ltsim-c++{}", path, is_image ? " --process" : "");
  return {};
}

}  // namespace

std::string scenario_name_of(const std::vector<std::string>& program) {
  if (program.front() == processes_program) {
    const auto options = parse_process_options({program.begin() + 1, program.end()});
    return options ? options->name() : "";
  }
  std::string name = std::filesystem::path{program.front()}.filename().string();
  make_one_word(name);
  return name;
}

std::string launch_program(const std::vector<std::string>& command, const std::vector<std::string>& program) {
  const bool is_of_processes = program.front() == processes_program;
  const std::string path = is_of_processes ? path_of_processes_program() : program.front();
  if (std::string wrong = what_is_wrong_with(path, false); !wrong.empty()) return wrong;
  if (is_of_processes) {
    const auto options = parse_process_options({program.begin() + 1, program.end()});
    if (!options) return options.error();
    for (const ProcessOptions& process : options->processes) {
      if (std::string wrong = what_is_wrong_with(process.arguments.front(), true); !wrong.empty())
        return wrong;
    }
  }
  std::string joined;
  for (const std::string& word : command) joined += word + separator;
  setenv(variable_of(is_of_processes ? LaunchedProgram::processes : LaunchedProgram::whole), joined.c_str(),
         1);
  if (is_of_processes) make_room_for_thread_locals();
  // Addresses that are the same in each run: what depends on their order does not differ then.
  personality(static_cast<unsigned long>(personality(0xffffffff)) | ADDR_NO_RANDOMIZE);
  // Functions of libraries are bound once, and not in each process that is forked.
  if (getenv(binding_variable) == nullptr) setenv(binding_variable, bound_by_us, 1);
  std::vector<char*> arguments;
  for (const std::string& word : program) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(path.c_str(), arguments.data());
  return fmt::format("{}: {}", path, strerror(errno));
}

std::optional<std::vector<std::string>> take_launch_command(LaunchedProgram program) {
  const char* const variable = variable_of(program);
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
