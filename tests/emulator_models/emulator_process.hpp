// plc-emulator as a process of its own, and a serial line to it.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace emulator_models {

class EmulatorProcess {
 public:
  explicit EmulatorProcess(const std::vector<std::string>& arguments);
  EmulatorProcess(const EmulatorProcess&) = delete;
  EmulatorProcess& operator=(const EmulatorProcess&) = delete;
  /// Kills what is still running.
  ~EmulatorProcess();

  /// Reads standard output and standard error until a line begins with `prefix`.
  /// @return the rest of that line; empty when the process ended without it
  [[nodiscard]] std::string wait_for_line(std::string_view prefix);
  /// @return whether `text` was printed; false = the process ended without it
  [[nodiscard]] bool wait_for_text(std::string_view text);
  void send_signal(int signal) const;
  /// @return the exit code; minus the signal's number when one ended the process
  [[nodiscard]] int wait_for_exit();
  /// All that it has printed and that was read so far.
  [[nodiscard]] const std::string& printed() const noexcept { return printed_; }

 private:
  /// @return false at the end of the output
  bool read_some();

  pid_t process_ = -1;
  int output_ = -1;
  std::string printed_;
};

/// A client's end of a pseudo-terminal.
class SerialLine {
 public:
  explicit SerialLine(const std::string& path);
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;
  ~SerialLine();

  void send(std::span<const std::byte> bytes) const;
  /// @return `count` bytes; fewer when none came for ten seconds
  [[nodiscard]] std::vector<std::byte> receive(std::size_t count) const;

 private:
  int terminal_ = -1;
};

}  // namespace emulator_models
