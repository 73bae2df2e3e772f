#include "tests/scenarios/paper_scenarios.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "sim_clock/scenario/scenario.hpp"

namespace scenarios {
namespace {

using namespace std::chrono_literals;
using protocol::PaperOptions;

constexpr auto time_outs = PaperExchange::TimeOuts::as_published;
constexpr ExchangeMonitor::Options reads{.repeatable = ExchangeMonitor::Repeatable::yes};

constexpr std::array table{
    PaperScenario{"paper/one-request", "the published handoff with its defaults, one request", "", {}},
    PaperScenario{"paper/three-requests",
                  "three requests and no time-out: the published handoff is sound here",
                  "",
                  {.requests = 3}},
    PaperScenario{"paper/time-out",
                  "K8: the kernel gives up a read after 100 ms and sends the next one",
                  "I1",
                  {.time_outs = time_outs, .requests = 3, .monitor = reads}},
    PaperScenario{
        "paper/semaphore-reset",
        "K3: the emulator sets the semaphore to 0 after each answer; nothing times out",
        "I9",
        {.options = {.semaphore_after_answer = PaperOptions::SemaphoreAfterAnswer::reset}, .requests = 2}},
    PaperScenario{"paper/late-emulator",
                  "the emulator is started up to 400 ms after the kernel, which times out after 100 ms",
                  "I5",
                  {.time_outs = time_outs, .requests = 3, .emulator_is_late = true}},

    PaperScenario{"paper/h01-answer-to-nothing",
                  "K1: the kernel reads at once, before anybody has answered",
                  "I1",
                  {.options = {.read_wait = PaperOptions::ReadWait::immediately}, .requests = 2}},
    PaperScenario{"paper/h02-new-length-old-bytes",
                  "K1: the kernel reads at once, while the answer is written",
                  "I4",
                  {.options = {.read_wait = PaperOptions::ReadWait::immediately}, .requests = 2}},
    PaperScenario{"paper/h03-stale-answer",
                  "after a time-out the late answer is delivered for the next request",
                  "I1",
                  {.time_outs = time_outs, .requests = 2, .monitor = reads}},
    PaperScenario{
        "paper/h03b-shifted-answers",
        "after one time-out each request gets the answer of the one before",
        "I1: the answer to request 2",
        {.time_outs = time_outs,
         .requests = 3,
         .monitor = {.repeatable = ExchangeMonitor::Repeatable::yes, .foreign_answers_tolerated = 1}}},
    PaperScenario{"paper/h04-invented-request",
                  "after a time-out the emulator reads while the next request is written over the last",
                  "I3",
                  {.time_outs = time_outs, .requests = 2, .monitor = reads}},
    PaperScenario{"paper/h05-executed-twice",
                  "after a time-out two posts and one area: the second request runs twice",
                  "I5",
                  {.time_outs = time_outs, .requests = 2}},
    PaperScenario{"paper/h05b-refused-yet-executed",
                  "K4: after a time-out a post is refused, its request is executed",
                  "I6",
                  {.options = {.semaphore_maximum = PaperOptions::SemaphoreMaximum::one},
                   .time_outs = time_outs,
                   .requests = 2}},
    PaperScenario{
        "paper/h06-lost-wake-up",
        "K3: the emulator sets the semaphore to 0 after each answer",
        "I9",
        {.options = {.semaphore_after_answer = PaperOptions::SemaphoreAfterAnswer::reset}, .requests = 2}},
    PaperScenario{"paper/h07-torn-answer",
                  "after a time-out the emulator writes an answer while the kernel reads one",
                  "I4",
                  {.time_outs = time_outs, .requests = 2, .monitor = reads}},
    PaperScenario{"paper/h08-wiped-answer",
                  "after a time-out the kernel's state := idle wipes an answer that just came",
                  "I18",
                  {.time_outs = time_outs, .requests = 2, .monitor = reads}},
    PaperScenario{"paper/h09-late-emulator",
                  "the emulator is started late, to a heap of posts and one request",
                  "I5",
                  {.time_outs = time_outs, .requests = 3, .emulator_is_late = true}},
    PaperScenario{"paper/h10-wiped-request",
                  "K5: the emulator fills the segment with zeros when it starts",
                  "I29",
                  {.options = {.initialiser = PaperOptions::Initialiser::slave}}},
    PaperScenario{"paper/h11-token-without-request",
                  "K10: the semaphore begins with a count of one",
                  "I11",
                  {.options = {.semaphore_start = PaperOptions::SemaphoreStart::one}}},
    PaperScenario{"paper/h13-sent-again",
                  "K8: after a time-out the kernel sends the same request again",
                  "I5",
                  {.options = {.on_time_out = PaperOptions::OnTimeOut::send_again}, .time_outs = time_outs}},
    PaperScenario{"paper/h15-two-threads",
                  "K11: two threads of the kernel send through one port",
                  "I1",
                  {.kernel_threads = 2, .monitor = reads}},
    PaperScenario{"paper/h16-two-emulators",
                  "K11: two emulators serve one segment",
                  "I28",
                  {.requests = 2, .emulators = 2}},
    PaperScenario{"paper/h18-lost-flag",
                  "K2: the state is two halves, each changed by load and store",
                  "I14",
                  {.options = {.state_coding = PaperOptions::StateCoding::halves},
                   .time_outs = time_outs,
                   .requests = 2,
                   .monitor = reads}},
    // The time-out is there to end the second read, which does not wait.
    PaperScenario{
        "paper/h26-answer-twice",
        "K7: nobody takes the state back, and the kernel looks twice",
        "I2",
        {.options = {.state_taken_back = PaperOptions::StateTakenBack::by_nobody, .read_timeout = 1h},
         .time_outs = time_outs,
         .reads_twice = true}},
};

template <std::size_t index>
void run(ltsim::World& world) {
  run_exchange(world, table[index].exchange);
}

template <std::size_t... indexes>
std::array<ltsim::ScenarioRegistration, sizeof...(indexes)> register_all(std::index_sequence<indexes...>) {
  return {ltsim::ScenarioRegistration{table[indexes].name, table[indexes].description, &run<indexes>}...};
}

const auto registrations = register_all(std::make_index_sequence<table.size()>{});

}  // namespace

std::span<const PaperScenario> paper_scenarios() { return table; }

bool is_shown_by(const PaperScenario& scenario, std::string_view message) {
  if (scenario.shows.find(':') != std::string_view::npos) return message.starts_with(scenario.shows);
  const std::string_view numbers = message.substr(0, message.find(':'));
  for (std::size_t at = 0; at <= numbers.size();) {
    const std::size_t end = std::min(numbers.find(", ", at), numbers.size());
    if (numbers.substr(at, end - at) == scenario.shows) return true;
    at = end + 2;
  }
  return false;
}

}  // namespace scenarios
