#include "protocol/paper_command_line.hpp"

#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace protocol {
namespace {

template <class Value>
void add_choice(CLI::App& app, const std::string& name, Value& value,
                const std::map<std::string, Value>& choices, const std::string& help) {
  // The library would show the enumeration's numbers as characters.
  std::string names;
  for (const auto& [text, unused] : choices) names += (names.empty() ? "" : "|") + text;
  CLI::CheckedTransformer transformer{choices, CLI::ignore_case};
  transformer.description(names);
  app.add_option(name, value, help)
      ->transform(transformer)
      ->type_name("CHOICE")
      ->group("What the published handoff leaves open (both sides must be told the same)");
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

void add_common_choices(CLI::App& app, PaperOptions& options) {
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

}  // namespace

void add_paper_options(CLI::App& app, PaperOptions& options, PaperSide side) {
  if (side == PaperSide::kernel) {
    add_kernel_choices(app, options);
  } else {
    add_emulator_choices(app, options);
  }
  add_common_choices(app, options);
}

}  // namespace protocol
