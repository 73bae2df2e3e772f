#include "protocol/handoff_command_line.hpp"

#include <map>
#include <vector>

#include <CLI/CLI.hpp>

#include "protocol/hardened/options.hpp"

namespace protocol {
namespace {

const std::string common_group = "Handoff over shared memory (both sides must be told the same)";
const std::string hardened_group = "The hardened handoff";
const std::string paper_group =
    "What the published handoff leaves open (with --protocol paper; both sides must be told the same)";

template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const std::map<std::string, Value>& choices, const std::string& help) {
  // The library would show the enumeration's numbers as characters.
  std::string names;
  for (const auto& [text, unused] : choices) names += (names.empty() ? "" : "|") + text;
  CLI::CheckedTransformer transformer{choices, CLI::ignore_case};
  transformer.description(names);
  return app.add_option(name, value, help)->transform(transformer)->type_name("CHOICE")->group(paper_group);
}

CLI::Option* add_milliseconds(CLI::App& app, const std::string& name, std::chrono::nanoseconds& value,
                              const std::string& help) {
  return app
      .add_option_function<unsigned>(
          name, [&value](unsigned ms) { value = std::chrono::milliseconds{ms}; }, help)
      ->check(CLI::Range(1, 3'600'000))
      ->default_str(std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(value).count()));
}

CLI::Option* add_capacity(CLI::App& app, const std::string& name, std::uint32_t& hardened,
                          std::uint32_t& paper, const std::string& help) {
  return app
      .add_option_function<std::uint32_t>(
          name, [&](std::uint32_t bytes) { hardened = paper = bytes; }, help)
      ->check(CLI::Range(1, 65'536))
      ->default_str(std::to_string(hardened));
}

void add_common_options(CLI::App& app, HandoffArguments& arguments) {
  add_choice<Handoff>(
      app, "--protocol", arguments.protocol, {{"hardened", Handoff::hardened}, {"paper", Handoff::paper}},
      "The hardened handoff, or the one that was published, hazards included (default hardened)")
      ->group(common_group);
  add_capacity(app, "--request-bytes-max", arguments.hardened.request_bytes_max,
               arguments.paper.request_bytes_max, "Longest request that has room")
      ->group(common_group);
  add_capacity(app, "--response-bytes-max", arguments.hardened.response_bytes_max,
               arguments.paper.response_bytes_max, "Longest response that has room")
      ->group(common_group);
}

void add_hardened_options(CLI::App& app, hardened::Options& options, HandoffSide side) {
  using Options = hardened::Options;
  add_choice<Options::Doorbells>(app, "--doorbells", options.doorbells,
                                 {{"two", Options::Doorbells::two}, {"one", Options::Doorbells::one}},
                                 "Semaphores: one each way, or one to the emulator, and the kernel polls\n"
                                 "(default two; both sides must be told the same)")
      ->group(hardened_group);
  if (side == HandoffSide::emulator) return;
  options.take_timeout = std::chrono::milliseconds{200};  // as long as --read-timeout-ms gives the answer
  add_milliseconds(
      app, "--take-timeout-ms", options.take_timeout,
      "Longest wait until the PLC has taken a request; then it is withdrawn, and was not executed")
      ->group(hardened_group);
  app.add_option(
         "--queries", options.queries_max,
         "How often the PLC is asked for the answer to a request that it has taken and not answered in\n"
         "time, before nobody knows whether it was executed")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str()
      ->group(hardened_group);
}

void add_kernel_choices(CLI::App& app, PaperOptions& options) {
  using Options = PaperOptions;
  add_choice<Options::ReadWait>(
      app, "--read-wait", options.read_wait,
      {{"poll", Options::ReadWait::poll}, {"immediately", Options::ReadWait::immediately}},
      "K1: does reading wait for the answer? (default poll)");
  add_choice<Options::SemaphoreMaximum>(
      app, "--semaphore-maximum", options.semaphore_maximum,
      {{"large", Options::SemaphoreMaximum::large}, {"one", Options::SemaphoreMaximum::one}},
      "K4: maximum count of the semaphore (default large)");
  add_choice<Options::StateTakenBack>(
      app, "--state-taken-back", options.state_taken_back,
      {{"by-master", Options::StateTakenBack::by_master}, {"by-nobody", Options::StateTakenBack::by_nobody}},
      "K7: who takes the state back from \"response\" (default by-master)");
  add_choice<Options::OnTimeOut>(app, "--on-time-out", options.on_time_out,
                                 {{"give-up", Options::OnTimeOut::give_up},
                                  {"wait-for-ever", Options::OnTimeOut::wait_for_ever},
                                  {"send-again", Options::OnTimeOut::send_again}},
                                 "K8: what follows when no answer comes (default give-up)");
}

void add_emulator_choices(CLI::App& app, PaperOptions& options) {
  using Options = PaperOptions;
  add_choice<Options::SemaphoreAfterAnswer>(
      app, "--semaphore-after-answer", options.semaphore_after_answer,
      {{"wait", Options::SemaphoreAfterAnswer::wait}, {"reset", Options::SemaphoreAfterAnswer::reset}},
      "K3: after an answer, wait for the semaphore or force it to 0 first (default wait)");
  add_choice<Options::Initialiser>(app, "--initialiser", options.initialiser,
                                   {{"creator", Options::Initialiser::creator},
                                    {"slave", Options::Initialiser::slave},
                                    {"creator-and-slave", Options::Initialiser::creator_and_slave},
                                    {"nobody", Options::Initialiser::nobody}},
                                   "K5: who fills the segment with zeros (default creator)");
}

void add_both_sides_choices(CLI::App& app, PaperOptions& options) {
  using Options = PaperOptions;
  add_choice<Options::StateCoding>(
      app, "--state-coding", options.state_coding,
      {{"enumeration", Options::StateCoding::enumeration}, {"halves", Options::StateCoding::halves}},
      "K2: coding of the state word (default enumeration)");
  add_choice<Options::AreaOrder>(
      app, "--area-order", options.area_order,
      {{"length-first", Options::AreaOrder::length_first}, {"bytes-first", Options::AreaOrder::bytes_first}},
      "K6: what of an area is written first (default length-first)");
  add_choice<Options::LengthCheck>(app, "--length-check", options.length_check,
                                   {{"none", Options::LengthCheck::none},
                                    {"check-and-load-again", Options::LengthCheck::check_and_load_again},
                                    {"load-once", Options::LengthCheck::load_once}},
                                   "K9: check of the length found in an area (default none)");
  add_choice<Options::SemaphoreStart>(app, "--semaphore-start", options.semaphore_start,
                                      {{"zero", Options::SemaphoreStart::zero},
                                       {"one", Options::SemaphoreStart::one},
                                       {"left-over", Options::SemaphoreStart::left_over}},
                                      "K10: count of the semaphore at the start (default zero)");
  add_choice<Options::AnswerOrder>(
      app, "--answer-order", options.answer_order,
      {{"as-published", Options::AnswerOrder::as_published},
       {"release-and-acquire", Options::AnswerOrder::release_and_acquire}},
      "K12: whether the state word orders the bytes of an answer, which nothing does as\n"
      "published (default as-published)");
}

void add_paper_options(CLI::App& app, PaperOptions& options, HandoffSide side) {
  if (side == HandoffSide::kernel) {
    add_kernel_choices(app, options);
  } else {
    add_emulator_choices(app, options);
  }
  add_both_sides_choices(app, options);
}

/// An option of the other handoff would be without effect.
void refuse_foreign_options(const CLI::App& app, Handoff protocol) {
  const bool is_paper = protocol == Handoff::paper;
  for (const CLI::Option* const option : app.get_options()) {
    if (option->count() == 0 || option->get_group() != (is_paper ? hardened_group : paper_group)) continue;
    throw CLI::ValidationError(option->get_name(),
                               is_paper ? "belongs to the hardened handoff. Leave it out, or --protocol paper"
                                        : "belongs to the published handoff. Give --protocol paper, too");
  }
}

}  // namespace

HandoffOptions HandoffArguments::options() const {
  return protocol == Handoff::paper ? HandoffOptions{paper} : HandoffOptions{hardened};
}

void add_handoff_options(CLI::App& app, HandoffArguments& arguments, HandoffSide side) {
  add_common_options(app, arguments);
  add_hardened_options(app, arguments.hardened, side);
  add_paper_options(app, arguments.paper, side);
  app.callback([&] { refuse_foreign_options(app, arguments.protocol); });
}

std::string why_no_plc(const std::string& segment_name, const HandoffOptions& options) {
  const auto found = handoff_of_segment(segment_name);
  if (found == kind_of(options)) return {};
  const std::string start = "Start one: " + emulator_command(segment_name, options);
  if (!found) return "there is no such segment. " + start;
  return *found == Handoff::paper
             ? "it has the published handoff. Give --protocol paper, or stop its emulator. " + start
             : "it has the hardened handoff. Leave out --protocol paper, or stop its emulator. " + start;
}

std::string emulator_command(const std::string& segment_name, const HandoffOptions& options) {
  std::string command = "plc-emulator --segment " + segment_name;
  if (kind_of(options) == Handoff::paper) command += " --protocol paper";
  return command;
}

}  // namespace protocol
