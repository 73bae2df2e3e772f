#include "emulator_models/send_configuration.hpp"

#include <array>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "emulator_models/configuration_sender.hpp"
#include "emulator_models/soft_plc/plc_configuration.hpp"
#include "protocol/handoff.hpp"
#include "protocol/posix_serial_port.hpp"
#include "protocol/role_lock.hpp"
#include "protocol/shared_memory_port_manager.hpp"

namespace emulator_models {
namespace {

constexpr int exit_taken = 0;
constexpr int exit_refused = 2;

int give_up(const std::string& message) {
  fmt::print(stderr, "plc-emulator: {}\n", message);
  return exit_refused;
}

int send(const std::string& path, protocol::SerialPort& port, const std::string& where) {
  const auto text = soft_plc::read_file(path);
  if (!text) return give_up(path + " cannot be read; check path and permissions");
  if (const auto opened = port.open(); !opened)
    return give_up(fmt::format("{}: {}", where, to_string(opened.error())));
  const auto sent = ConfigurationSender{port}.send(*text);
  if (sent) {
    fmt::print("{}: taken by the PLC on {}\n", path, where);
    return exit_taken;
  }
  if (!sent.error().is_refusal)
    return give_up(
        fmt::format("{}: {}; nobody knows whether {} was taken", where, sent.error().reason, path));
  // The PLC names the place in the text, and leaves the file's name to who knows it.
  const bool has_place = sent.error().reason.starts_with(':');
  return give_up(fmt::format("refused by the PLC on {}, its configuration of before goes on: {}{}{}", where,
                             path, has_place ? "" : ": ", sent.error().reason));
}

int send_to_segment(const std::string& path, const EmulatorOptions& options) {
  const std::string where = fmt::format("segment '{}'", options.segment_name);
  protocol::RoleLock role{options.segment_name, protocol::Role::kernel};
  if (const auto locked = role.try_lock(); !locked)
    return give_up(
        locked.error() == protocol::RoleLockError::held_by_other
            ? fmt::format("{}: a kernel is attached. Stop it, or send over the line (--pty)", where)
            : fmt::format("{}: {}", where, to_string(locked.error())));
  const protocol::HandoffOptions handoff = options.handoff.options();
  // Opening would create what is missing, and leave behind a segment that nobody serves.
  if (const std::string why = protocol::why_no_plc(options.segment_name, handoff); !why.empty())
    return give_up(fmt::format("no PLC on {}: {}", where, why));
  protocol::SharedMemoryPortManager ports{handoff};
  const auto port = ports.port(options.segment_name);
  if (!port) return give_up(fmt::format("{}: {}", where, to_string(port.error())));
  const int code = send(path, **port, where);
  (*port)->close();
  protocol::remove_if_unused(options.segment_name, handoff);
  return code;
}

}  // namespace

void add_send_configuration_options(CLI::App& app, SendConfigurationOptions& options) {
  constexpr std::array excluded{"--config",         "--pty",         "--model",  "--program",
                                "--plant",          "--failure",     "--watch",  "--cold",
                                "--scan-period-ms", "--watchdog-ms", "--archive"};
  CLI::Option* const send =
      app.add_option("--send-config", options.path,
                     "Send this TOML file to a PLC that runs with --config, over --segment or --port");
  for (const char* const name : excluded) send->excludes(app.get_option(name));
  app.add_option("--port", options.device, "With --send-config: the line, as /dev/pts/3")
      ->needs(send)
      ->excludes(app.get_option("--segment"));
}

int run_send_configuration(const SendConfigurationOptions& options, const EmulatorOptions& port) {
  if (options.device.empty() && port.segment_name.empty())
    return give_up("where is the PLC? --segment NAME or --port PATH");
  if (options.device.empty()) return send_to_segment(options.path, port);
  protocol::PosixSerialPort line{options.device};
  return send(options.path, line, options.device);
}

}  // namespace emulator_models
