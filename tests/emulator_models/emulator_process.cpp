#include "tests/emulator_models/emulator_process.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

namespace emulator_models {

EmulatorProcess::EmulatorProcess(const std::vector<std::string>& arguments) {
  int ends[2];
  if (::pipe(ends) != 0) std::abort();
  process_ = ::fork();
  if (process_ == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    std::string program = PLC_EMULATOR_PATH;
    std::vector<std::string> words = arguments;
    // A machine that is busy with other tests must not look like a PLC that hangs.
    const auto is_given = [&](std::string_view option) {
      return std::ranges::find(words, option) != words.end();
    };
    if (!is_given("--watchdog-ms") && !is_given("--config") && !is_given("--send-config"))
      words.insert(words.end(), {"--watchdog-ms", "30000"});
    std::vector<char*> argv{program.data()};
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  output_ = ends[0];
}

EmulatorProcess::~EmulatorProcess() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(output_);
}

bool EmulatorProcess::read_some() {
  char text[256];
  const ssize_t count = ::read(output_, text, sizeof text);
  if (count > 0) printed_.append(text, static_cast<std::size_t>(count));
  return count > 0;
}

std::string EmulatorProcess::wait_for_line(std::string_view prefix) {
  std::size_t line = 0;
  for (;;) {
    const std::size_t end = printed_.find('\n', line);
    if (end == std::string::npos) {
      if (!read_some()) return {};
      continue;
    }
    const std::string_view text = std::string_view{printed_}.substr(line, end - line);
    if (text.starts_with(prefix)) return std::string{text.substr(prefix.size())};
    line = end + 1;
  }
}

bool EmulatorProcess::wait_for_text(std::string_view text) {
  while (printed_.find(text) == std::string::npos)
    if (!read_some()) return false;
  return true;
}

void EmulatorProcess::send_signal(int signal) const { ::kill(process_, signal); }

int EmulatorProcess::wait_for_exit() {
  while (read_some()) {
  }
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

SerialLine::SerialLine(const std::string& path) : terminal_{::open(path.c_str(), O_RDWR | O_NOCTTY)} {
  termios line{};
  ::tcgetattr(terminal_, &line);
  ::cfmakeraw(&line);
  ::tcsetattr(terminal_, TCSANOW, &line);
}

SerialLine::~SerialLine() { ::close(terminal_); }

void SerialLine::send(std::span<const std::byte> bytes) const {
  if (::write(terminal_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) std::abort();
}

std::vector<std::byte> SerialLine::receive(std::size_t count) const {
  constexpr int silence_ms = 10'000;
  std::vector<std::byte> received;
  while (received.size() < count) {
    pollfd waited{terminal_, POLLIN, 0};
    std::byte byte{};
    if (::poll(&waited, 1, silence_ms) != 1 || ::read(terminal_, &byte, 1) != 1) break;
    received.push_back(byte);
  }
  return received;
}

}  // namespace emulator_models
