#include "sim_clock/program/process_options.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "sim_clock/world/object_names.hpp"
#include "sim_clock/world/segments.hpp"

namespace ltsim {
namespace {

/// As they were typed.
struct Typed {
  std::vector<std::string> processes;
  std::vector<std::string> services;
  std::vector<std::string> crashes;
  std::vector<std::string> stalls;
  std::vector<std::string> faults;
};

void add_options(CLI::App& app, Typed& typed, WorldOptions& options) {
  app.set_help_flag();
  const auto one_each = [](CLI::Option* option) {
    option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  one_each(app.add_option(
      "--process", typed.processes,
      "IMAGE[:ARGUMENTS]: a program that ltsim-c++ --process has built, as a process of the world"));
  one_each(app.add_option(
      "--service", typed.services,
      "the same, for one that runs until it gets SIGTERM, which it waits for (sigwait(3)): it is started "
      "first, the processes when it waits, and it gets SIGTERM when all of them have ended"));
  one_each(app.add_option(
      "--crash", typed.crashes,
      "NAME[:MS]: the process may be killed once, as by kill -9, anywhere; with MS it is started again so "
      "many milliseconds later. NAME is the image's, without folder and ending"));
  one_each(app.add_option("--stall", typed.stalls,
                          "NAME: the process may get no processor for a while, once, for 1 ms to 10 s"));
  one_each(app.add_option("--fault", typed.faults,
                          "KIND[:TIMES]: e.g. interrupt, call-failure, lost-post, clock-step"));
  app.add_option("--exit-status", options.exit_statuses, "those that are no failure")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0, 255))
      ->capture_default_str();
  app.add_option_function<unsigned>(
         "--within", [&options](unsigned seconds) { options.within = std::chrono::seconds{seconds}; },
         "seconds of virtual time: a failure if all has not ended by then")
      ->check(CLI::Range(1U, 1'000'000U));
  app.add_flag("--steady", options.is_steady,
               "nobody is slow but by --stall: time passes only when nobody can run");
  app.add_option("--points", options.points_max, "more scheduling points than this are a livelock")
      ->check(CLI::PositiveNumber);
}

/// "name" and "rest" of "name:rest"; the rest is empty where there is no colon.
std::pair<std::string, std::string> at_colon(const std::string& text) {
  const std::size_t colon = text.find(':');
  return {text.substr(0, colon), colon == std::string::npos ? "" : text.substr(colon + 1)};
}

std::optional<unsigned> as_number(const std::string& text) {
  unsigned number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

class Reader {
 public:
  explicit Reader(WorldOptions& options) : options_(options) {}

  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }

  void add_process(const std::string& text, bool is_service) {
    const auto [path, rest] = at_colon(text);
    std::string name = std::filesystem::path{path}.stem().string();
    make_one_word(name);
    const auto same =
        std::count_if(options_.processes.begin(), options_.processes.end(), [&](const auto& other) {
          return std::filesystem::path{other.arguments.front()}.stem() == std::filesystem::path{path}.stem();
        });
    if (same != 0) name += fmt::format("-{}", same + 1);
    if (path.empty()) return fail(fmt::format("\"{}\" begins with no image", text));
    ProcessOptions process{.name = std::move(name), .arguments = {path}, .is_service = is_service};
    if (!rest.empty()) {
      for (std::string& word : CLI::detail::split_up(rest)) process.arguments.push_back(std::move(word));
    }
    options_.processes.push_back(std::move(process));
  }

  void add_crash(const std::string& text) {
    const auto [name, rest] = at_colon(text);
    ProcessOptions* const process = find(name);
    if (process == nullptr) return;
    const auto milliseconds = as_number(rest);
    if (!rest.empty() && !milliseconds)
      return fail(fmt::format("--crash {}: \"{}\" is no number of milliseconds", text, rest));
    process->crash = CrashGrant{.times = process->crash ? process->crash->times + 1 : 1, .restart_after = {}};
    if (milliseconds) process->crash->restart_after = std::chrono::milliseconds{*milliseconds};
  }

  void add_stall(const std::string& name) {
    if (ProcessOptions* const process = find(name); process != nullptr) ++process->stalls;
  }

  void add_fault(const std::string& text) {
    const auto [name, rest] = at_colon(text);
    const auto times = rest.empty() ? std::optional{1U} : as_number(rest);
    for (std::size_t i = 0; i < fault_kinds_count; ++i) {
      const auto kind = static_cast<FaultKind>(i);
      const bool is_of_its_own = kind == FaultKind::crash || kind == FaultKind::process_stall ||
                                 kind == FaultKind::bit_flip || kind == FaultKind::foreign_write;
      if (to_string(kind) != name || is_of_its_own) continue;
      if (!times) return fail(fmt::format("--fault {}: \"{}\" is no number", text, rest));
      options_.faults.push_back({kind, *times});
      return;
    }
    fail(fmt::format(
        "--fault {}: there is no fault \"{}\"; there are lost-post, doubled-post, spurious-wake, interrupt, "
        "clock-step, call-failure, and --crash and --stall",
        text, name));
  }

 private:
  void fail(std::string trouble) {
    if (trouble_.empty()) trouble_ = std::move(trouble);
  }

  ProcessOptions* find(const std::string& name) {
    const auto found = std::find_if(options_.processes.begin(), options_.processes.end(),
                                    [&](const ProcessOptions& process) { return process.name == name; });
    if (found != options_.processes.end()) return &*found;
    std::string names;
    for (const ProcessOptions& process : options_.processes)
      names += (names.empty() ? "" : ", ") + process.name;
    fail(fmt::format("there is no process \"{}\"; there are {}", name, names));
    return nullptr;
  }

  WorldOptions& options_;
  std::string trouble_;
};

}  // namespace

std::string WorldOptions::name() const {
  std::string name;
  for (const ProcessOptions& process : processes) name += (name.empty() ? "" : "+") + process.name;
  return name;
}

tl::expected<WorldOptions, std::string> parse_process_options(const std::vector<std::string>& arguments) {
  CLI::App app;
  Typed typed;
  WorldOptions options;
  add_options(app, typed, options);
  try {
    app.parse(std::vector<std::string>{arguments.rbegin(), arguments.rend()});
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(std::string{error.what()});
  }
  Reader reader{options};
  for (const std::string& service : typed.services) reader.add_process(service, true);
  for (const std::string& process : typed.processes) reader.add_process(process, false);
  for (const std::string& crash : typed.crashes) reader.add_crash(crash);
  for (const std::string& stall : typed.stalls) reader.add_stall(stall);
  for (const std::string& fault : typed.faults) reader.add_fault(fault);
  if (!reader.trouble().empty()) return tl::unexpected(reader.trouble());
  if (typed.processes.empty())
    return tl::unexpected(std::string{"no --process: a world of services never ends"});
  if (options.processes.size() > processes_max)
    return tl::unexpected(
        fmt::format("{} processes; one world has at most {}", options.processes.size(), processes_max));
  return options;
}

std::vector<std::string> take_process_options(std::vector<std::string>& command) {
  CLI::App app;
  Typed typed;
  WorldOptions options;
  add_options(app, typed, options);
  std::vector<std::string> taken;
  std::vector<std::string> left;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const std::string& word = command[i];
    const std::size_t equals = word.find('=');
    const CLI::Option* const option =
        word.starts_with("--") ? app.get_option_no_throw(word.substr(0, equals)) : nullptr;
    (option == nullptr ? left : taken).push_back(word);
    const bool value_follows =
        option != nullptr && option->get_items_expected_max() != 0 && equals == std::string::npos;
    if (value_follows && i + 1 < command.size()) taken.push_back(command[++i]);
  }
  command = std::move(left);
  return taken;
}

std::string process_options_help() {
  CLI::App app;
  Typed typed;
  WorldOptions options;
  add_options(app, typed, options);
  std::string text = "\nWhole programs as processes of one world, instead of scenarios:\n";
  for (const CLI::Option* const option : app.get_options())
    text += CLI::Formatter{}.make_option(option, false);
  return text;
}

}  // namespace ltsim
