// fuzz-NAME where no fuzzing engine is linked: runs the target over files.
//
//   fuzz-fx-frame FILE|FOLDER...
//
// A file holds an input as it is, or, called *.schedule, a schedule: its "input" lines are the input, and where the bytes are the choices of a
// scenario it is replayed. A choice that no longer fits there is told and is no failure: what was wrong at that place is often
// mended by taking the place away, and the outcome says whether it is. A folder stands for all files in it. Exit code: 0 all
// passed, 1 one failed, 2 a file cannot be read or there was none. A signal ends the run; the file is told before.

#include <algorithm>
#include <csignal>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>

#include "fuzz/schedule_input.hpp"
#include "sim_clock/explore/schedule.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

namespace fs = std::filesystem;

std::string file_under_way;

extern "C" void tell_file(int /*signal*/) {
  const auto write_text = [](const char* text, std::size_t size) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, size);
  };
  constexpr std::string_view head = "the signal came in ";
  write_text(head.data(), head.size());
  write_text(file_under_way.data(), file_under_way.size());
  write_text("\n", 1);
}

void tell_file_on_signals() {
  struct sigaction action{};
  action.sa_handler = tell_file;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // and it comes again, for good
  for (const int signal : {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV}) sigaction(signal, &action, nullptr);
}

/// @return files in order of their names, so that a run is the same everywhere
std::vector<fs::path> files_of(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// @return whether it passed
bool run(const ltsim::FuzzTarget& target, const fs::path& file, const std::string& text) {
  file_under_way = file.string();
  try {
    const bool is_schedule = file.extension() == ".schedule";
    if (const auto schedule = ltsim::parse_schedule(text); is_schedule && schedule && target.needs_world()) {
      const std::string unfit = target.scenario.replay(*schedule);
      if (!unfit.empty()) fmt::print("{}: passed, though this no longer fits: {}\n", file.string(), unfit);
      return true;
    }
    const std::string input = is_schedule ? fuzz::input_of(text).value_or(text) : text;
    target.run(std::as_bytes(std::span{input}));
    return true;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", file.string(), error.what());
    return false;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: {} FILE|FOLDER...\n", argv[0]);
    return 2;
  }
  const ltsim::FuzzTarget& target = ltsim::fuzz_targets().front();
  tell_file_on_signals();
  std::size_t passed = 0;
  std::size_t failed = 0;
  for (int i = 1; i < argc; ++i) {
    for (const fs::path& file : files_of(argv[i])) {
      std::ifstream stream{file, std::ios::binary};
      std::ostringstream text;
      if (!stream || !(text << stream.rdbuf() || fs::file_size(file) == 0)) {
        fmt::print(stderr, "{}: {}\n", file.string(), std::strerror(errno));
        return 2;
      }
      ++(run(target, file, text.str()) ? passed : failed);
    }
  }
  fmt::print("{}: {} passed, {} failed\n", target.name, passed, failed);
  if (passed + failed == 0) return 2;
  return failed == 0 ? 0 : 1;
}
