// The scenarios of the published handoff.
//
// Three show it as it is, with all invariants watched at once; then, one row a hazard: what the hazard needs,
// and nothing else, and the one invariant that it is known by. The search knows neither. Names begin with the
// hazard's number in protocol/README.md. Each hazard is a shape: "-corrected" makes the same requests inside the
// envelope in which the design is sound. A memory that is not sequentially consistent cannot be taken back into
// that: the requests are made there with the order that the design lacks.

#include <array>
#include <chrono>
#include <string>
#include <utility>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/paper_exchange.hpp"

namespace {

using namespace std::chrono_literals;
using protocol::PaperOptions;
using scenarios::ExchangeMonitor;
using scenarios::PaperExchange;
using scenarios::run_exchange;
using Killed = PaperExchange::Killed;

constexpr auto time_outs = PaperExchange::TimeOuts::as_published;

/// Judged by one invariant; the requests write, so that executing one twice does harm.
constexpr ExchangeMonitor::Options writes(std::string_view invariant) { return {.only = invariant}; }
/// Judged by one invariant; the requests read.
constexpr ExchangeMonitor::Options reads(std::string_view invariant) {
  return {.only = invariant, .repeatable = ExchangeMonitor::Repeatable::yes};
}

struct Hazard {
  std::string_view name;
  std::string_view description;
  unsigned depth;  // protocol.md 3.4
  PaperExchange exchange;
  ltsim::Memory memory = ltsim::Memory::sc;
};

constexpr bool needs_weak_memory(const Hazard& hazard) { return hazard.memory == ltsim::Memory::c11; }

PaperExchange corrected(const Hazard& hazard) {
  PaperExchange sound = inside_envelope(hazard.exchange);
  if (needs_weak_memory(hazard)) sound.options.answer_order = PaperOptions::AnswerOrder::release_and_acquire;
  return sound;
}

constexpr std::array hazards{
    Hazard{"paper/h01-answer-to-nothing",
           "K1: the kernel reads at once, before anybody has answered",
           1,
           {.options = {.read_wait = PaperOptions::ReadWait::immediately},
            .requests = 2,
            .monitor = reads("I1")}},
    Hazard{"paper/h02-new-length-old-bytes",
           "K1: the kernel reads at once, while the answer is written",
           2,
           {.options = {.read_wait = PaperOptions::ReadWait::immediately},
            .requests = 2,
            .monitor = reads("I4")}},
    Hazard{"paper/h03-stale-answer",
           "after a time-out the late answer is delivered for the next request",
           2,
           {.time_outs = time_outs, .requests = 2, .monitor = reads("I1")}},
    Hazard{"paper/h03b-shifted-answers",
           "after a time-out each request gets the answer of the one before",
           4,
           {.time_outs = time_outs,
            .requests = 3,
            .monitor = {.only = "I1",
                        .repeatable = ExchangeMonitor::Repeatable::yes,
                        .foreign_answers_tolerated = 1}}},
    Hazard{"paper/h04-invented-request",
           "after a time-out the emulator reads while the next request is written over the last",
           2,
           {.time_outs = time_outs, .requests = 2, .monitor = reads("I3")}},
    Hazard{"paper/h05-executed-twice",
           "after a time-out: two posts and one area, the second request runs twice",
           1,
           {.time_outs = time_outs, .requests = 2, .monitor = writes("I5")}},
    Hazard{"paper/h05b-refused-yet-executed",
           "K4: after a time-out a post is refused, and its request is executed",
           1,
           {.options = {.semaphore_maximum = PaperOptions::SemaphoreMaximum::one},
            .time_outs = time_outs,
            .requests = 2,
            .monitor = writes("I6")}},
    Hazard{"paper/h06-lost-wake-up",
           "K3: the emulator sets the semaphore to 0 after each answer",
           1,
           {.options = {.semaphore_after_answer = PaperOptions::SemaphoreAfterAnswer::reset},
            .requests = 2,
            .monitor = writes("I9")}},
    Hazard{"paper/h07-torn-answer",
           "after a time-out the emulator writes an answer while the kernel reads one",
           3,
           {.time_outs = time_outs, .requests = 2, .monitor = reads("I4")}},
    Hazard{"paper/h08-wiped-answer",
           "after a time-out the kernel's state := idle wipes an answer that just came",
           3,
           {.time_outs = time_outs, .requests = 2, .monitor = reads("I18")}},
    Hazard{"paper/h09-late-emulator",
           "an emulator that starts late finds a heap of posts and one request",
           1,
           {.time_outs = time_outs, .requests = 3, .emulator_is_late = true, .monitor = writes("I5")}},
    Hazard{"paper/h10-wiped-request",
           "K5: the emulator fills the segment with zeros when it starts",
           1,
           {.options = {.initialiser = PaperOptions::Initialiser::slave}, .monitor = writes("I29")}},
    Hazard{"paper/h11-token-without-request",
           "K10: the semaphore begins with a count of one",
           1,
           {.options = {.semaphore_start = PaperOptions::SemaphoreStart::one}, .monitor = writes("I11")}},
    Hazard{"paper/h12-killed-emulator",
           "the emulator is killed with a request in its hands, and started again",
           2,
           {.requests = 2, .killed = Killed::emulator, .monitor = writes("I17")}},
    Hazard{"paper/h13-sent-again",
           "K8: after a time-out the kernel sends the same request again",
           1,
           {.options = {.on_time_out = PaperOptions::OnTimeOut::send_again},
            .time_outs = time_outs,
            .monitor = writes("I5")}},
    Hazard{"paper/h14-killed-kernel",
           "the answer to a kernel that was killed is delivered to the next one",
           2,
           {.requests = 2, .killed = Killed::kernel, .monitor = reads("I1")}},
    Hazard{"paper/h14b-killed-kernel-invents",
           "a kernel is killed, the next one writes while the emulator reads",
           2,
           {.requests = 2, .killed = Killed::kernel, .monitor = reads("I3")}},
    Hazard{"paper/h15-two-threads",
           "K11: two threads of the kernel send through one port",
           1,
           {.kernel_threads = 2, .monitor = reads("I1")}},
    Hazard{"paper/h16-two-emulators",
           "K11: two emulators serve one segment",
           2,
           {.requests = 2, .emulators = 2, .monitor = writes("I28")}},
    Hazard{"paper/h17-answer-before-its-bytes",
           "the state says response before the bytes are there (memory c11)",
           1,
           {.monitor = reads("I4")},
           ltsim::Memory::c11},
    Hazard{"paper/h18-lost-flag",
           "K2: the state is two halves, each changed by load, modification and store",
           2,
           {.options = {.state_coding = PaperOptions::StateCoding::halves},
            .time_outs = time_outs,
            .requests = 2,
            .monitor = reads("I14")}},
    // The time-out is there to end the second read, which does not wait.
    Hazard{"paper/h26-answer-twice",
           "K7: nobody takes the state back, and the kernel looks twice",
           1,
           {.options = {.state_taken_back = PaperOptions::StateTakenBack::by_nobody, .read_timeout = 1h},
            .time_outs = time_outs,
            .reads_twice = true,
            .monitor = reads("I2")}},
};

template <std::size_t index>
void register_one() {
  constexpr const Hazard& hazard = hazards[index];
  static const std::string corrected_name = std::string{hazard.name} + "-corrected";
  const ltsim::ShapeRegistration registration{
      hazard.name,
      corrected_name,
      {.finding = hazard.exchange.monitor.only,
       .depth = hazard.depth,
       .tasks_count = 1 + hazard.exchange.kernel_threads + (hazard.exchange.emulators - 1),
       .memory = hazard.memory,
       .cure = needs_weak_memory(hazard)
                   ? "K12: the answer is announced with release and looked for with acquire"
                   : "the same requests inside the envelope of the published handoff"},
      hazard.description,
      [](ltsim::World& world) { run_exchange(world, hazards[index].exchange); },
      [](ltsim::World& world) { run_exchange(world, corrected(hazards[index])); }};
}

template <std::size_t... indexes>
bool register_all(std::index_sequence<indexes...>) {
  (register_one<indexes>(), ...);
  return true;
}

const bool registered = register_all(std::make_index_sequence<hazards.size()>{});

}  // namespace

SCENARIO("paper/one-request", "the published handoff with its defaults, one request") {
  run_exchange(world, {});
}

SCENARIO("paper/three-requests", "three requests and no time-out: the published handoff is sound here") {
  run_exchange(world, {.requests = 3});
}

SCENARIO("paper/time-out", "K8: the kernel gives up a read after 100 ms and sends the next one") {
  run_exchange(
      world,
      {.time_outs = time_outs, .requests = 3, .monitor = {.repeatable = ExchangeMonitor::Repeatable::yes}});
}

SCENARIO("paper/semaphore-reset",
         "K3: the emulator sets the semaphore to 0 after each answer; nothing times out") {
  run_exchange(world, {.options = {.semaphore_after_answer = PaperOptions::SemaphoreAfterAnswer::reset},
                       .requests = 2});
}

SCENARIO("paper/late-emulator",
         "the emulator is started up to 400 ms after the kernel, which times out after 100 ms") {
  run_exchange(world, {.time_outs = time_outs, .requests = 3, .emulator_is_late = true});
}
