// The scenarios of the hardened handoff: under time-outs and kills wherever they can strike no invariant breaks, with two
// doorbells and with one; and the mutants, each of which lacks a rule of the protocol and is found by one invariant, or
// has one of its memory orders relaxed and is found as a data race.

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "protocol/hardened/state_word.hpp"
#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/hardened/hardened_exchange.hpp"

namespace {

using namespace std::chrono_literals;
using protocol::hardened::Options;
using protocol::hardened::Orders;
using protocol::hardened::Phase;
using protocol::hardened::Rules;
using protocol::hardened::StateWord;
using scenarios::HardenedExchange;
using scenarios::run_hardened_exchange;
constexpr auto never = HardenedExchange::TimeOuts::never;

struct SetUp {
  std::string_view name;
  std::string_view description;
  HardenedExchange exchange;
};

constexpr Options three_attempts{.queries_max = 2};

constexpr std::array set_ups{
    SetUp{"hardened/three-requests",
          "no time-out fires, nobody is killed",
          {.time_outs = never, .requests = 3}},
    SetUp{"hardened/time-outs",
          "two requests, three attempts each, time-outs wherever the other side is late",
          {.options = three_attempts, .requests = 2}},
    SetUp{"hardened/emulator-killed",
          "two requests, time-outs; the emulator is killed once",
          {.requests = 2, .emulator_kills = 1}},
    SetUp{"hardened/kernel-killed",
          "one request a session, time-outs; the kernel is killed once",
          {.requests = 1, .kernel_kills = 1}},
    SetUp{"hardened/both-killed",
          "one request a session, time-outs; each side is killed once",
          {.requests = 1, .kernel_kills = 1, .emulator_kills = 1}},
    SetUp{"hardened/emulator-killed-twice",
          "one request, three attempts, time-outs; the emulator is killed twice",
          {.options = three_attempts, .requests = 1, .emulator_kills = 2}},
    SetUp{"hardened/queries-emulator-killed",
          "two requests, three attempts each, time-outs; the emulator is killed once",
          {.options = three_attempts, .requests = 2, .emulator_kills = 1}},
    SetUp{"hardened/two-requests-both-killed",
          "two requests a session, time-outs; each side is killed once",
          {.requests = 2, .kernel_kills = 1, .emulator_kills = 1}},
    SetUp{"hardened/emulator-twice-kernel-once",
          "one request a session, time-outs; the emulator is killed twice, the kernel once",
          {.requests = 1, .kernel_kills = 1, .emulator_kills = 2}},
    SetUp{"hardened/odd-rings",
          "two requests, time-outs; posts count twice, waits end by a signal",
          {.requests = 2, .odd_rings = 3}},
    SetUp{"hardened/wraps",
          "generation and sequence begin just before they wrap; time-outs; each side is killed once",
          {.options = {.first_sequence = 0xFFFF},
           .requests = 2,
           .kernel_kills = 1,
           .emulator_kills = 1,
           .word = encode(StateWord{Phase::down, StateWord::generation_max - 1, 0xFFFE})}},
    SetUp{"hardened/what-was-left",
          "a former emulator has died with a request in its hands; time-outs; each side is killed once",
          {.requests = 1,
           .kernel_kills = 1,
           .emulator_kills = 1,
           .word = encode(StateWord{Phase::busy, 7, 7})}},
    SetUp{"hardened/opened-together",
          "both sides make the segment at the same time; each is killed once",
          {.requests = 1, .kernel_kills = 1, .emulator_kills = 1, .opens_together = true}},
    SetUp{"hardened/rivals",
          "a second kernel and a second emulator wait for their role; time-outs; the emulator is killed once",
          {.requests = 1, .emulator_kills = 1, .has_rivals = true}},
    SetUp{"hardened/emulator-stops",
          "the emulator stops in an orderly way, and is started again; the kernel is killed once",
          {.requests = 2, .kernel_kills = 1, .emulator_stops = true}},
    SetUp{"hardened/lost-rings", "two requests, time-outs; posts are lost", {.requests = 2, .lost_rings = 2}},
    SetUp{"hardened/clock-steps",
          "two requests, time-outs; the wall clock is set, forward and back; the emulator is killed once, a "
          "post lost",
          {.requests = 2, .emulator_kills = 1, .lost_rings = 1, .clock_steps = 3}},
    SetUp{"hardened/foreign-writes",
          "somebody else writes into the segment: nothing is executed that was not submitted",
          {.requests = 2, .emulator_kills = 1, .foreign_writes = 4, .only = "I3"}},
};

template <std::size_t index>
void register_set_up() {
  constexpr const SetUp& set_up = set_ups[index];
  static const std::string one_name = std::string{set_up.name} + "-one-doorbell";
  static const std::string one_description =
      std::string{set_up.description} + "; one doorbell, the kernel polls";
  const ltsim::ScenarioRegistration two{set_up.name, set_up.description, [](ltsim::World& world) {
                                          run_hardened_exchange(world, set_ups[index].exchange);
                                        }};
  const ltsim::ScenarioRegistration one{one_name, one_description, [](ltsim::World& world) {
                                          HardenedExchange exchange = set_ups[index].exchange;
                                          exchange.options.doorbells = Options::Doorbells::one;
                                          run_hardened_exchange(world, exchange);
                                        }};
}

struct Mutant {
  std::string_view name;
  std::string_view description;
  std::string_view finding;
  unsigned depth;
  std::string_view cure;
  HardenedExchange exchange;
};

constexpr Options without(bool Rules::* rule) {
  Options options;
  options.rules.*rule = false;
  return options;
}

constexpr Options without(bool Rules::* rule, bool Rules::* other) {
  Options options = without(rule);
  options.rules.*other = false;
  return options;
}

constexpr Options relaxed(std::memory_order Orders::* order) {
  Options options;
  options.doorbells = Options::Doorbells::one;  // the second one would order memory as well
  options.orders.*order = std::memory_order_relaxed;
  return options;
}

/// Not an invariant of the monitor's: the world itself finds it.
constexpr std::string_view data_race = "data-race";

constexpr std::array mutants{
    Mutant{"hardened/m1-answer-stored",
           "a response is published by a store, and the kernel had given up",
           "I17",
           2,
           "a swap from BUSY; if it fails, the answer is dropped",
           {.options = without(&Rules::answer_by_swap), .requests = 1}},
    Mutant{"hardened/m2-withdrawn-by-a-store",
           "a request is withdrawn by a store, and the emulator has just taken it",
           "I6",
           2,
           "a swap from REQUEST; if it fails, the request was taken",
           {.options = without(&Rules::withdraw_by_swap), .requests = 1}},
    Mutant{"hardened/m3-doorbell-trusted",
           "the emulator takes a ring for a request",
           "I7",
           2,
           "after a ring the state word decides",
           {.options = without(&Rules::phase_decides), .requests = 2}},
    Mutant{"hardened/m4-no-duplicate-store",
           "a query is executed as if it were a request",
           "I5",
           1,
           "the answer to the last request is kept for its queries",
           {.options = without(&Rules::duplicate_store), .requests = 1}},
    Mutant{"hardened/m5-same-generation",
           "a new emulator attaches and nobody can tell",
           "I5",
           2,
           "each attach advances the generation",
           {.options = without(&Rules::generation_advances), .requests = 1, .emulator_kills = 1}},
    Mutant{"hardened/m6-doubt-forgotten",
           "a request that was given up is reported as not executed",
           "I6",
           1,
           "what is in doubt ends as unknown",
           {.options = without(&Rules::doubt_is_kept), .requests = 1}},
    Mutant{"hardened/m7-generation-checked-early",
           "the generation of a query is checked before the swap that publishes it, and not by it",
           "I5",
           3,
           "the query is published by a swap from the word that was checked",
           {.options = without(&Rules::query_from_first_generation), .requests = 1, .emulator_kills = 1}},
    Mutant{"hardened/m8-emptied-after-the-look",
           "an emulator that attaches empties its doorbell after it has looked at the state word",
           "I9",
           2,
           "first empty the doorbell, then look",
           {.options = without(&Rules::empties_before_look), .requests = 1, .emulator_kills = 1}},
    Mutant{"hardened/m9-with-one-sequence",
           "a request is copied before it is taken, and the next one has the same sequence number",
           "I6",
           3,
           "first take, then copy",
           {.options = without(&Rules::take_before_read, &Rules::sequence_advances), .requests = 2}},
    Mutant{"hardened/relaxed-look",
           "the kernel reads an answer after a look that orders nothing",
           data_race,
           1,
           "acquire: the answer was written before the word that says so",
           {.options = relaxed(&Orders::look)}},
    Mutant{"hardened/relaxed-publish",
           "a request is published by a swap that orders nothing",
           data_race,
           1,
           "release: the request is written before the word that says so",
           {.options = relaxed(&Orders::publish)}},
    Mutant{"hardened/relaxed-take",
           "a request is taken by a swap that orders nothing",
           data_race,
           1,
           "acquire: the request was written before the word that says so",
           {.options = relaxed(&Orders::take)}},
    Mutant{"hardened/relaxed-answer",
           "an answer is published by a swap that orders nothing",
           data_race,
           1,
           "release: the answer is written before the word that says so",
           {.options = relaxed(&Orders::answer)}},
    Mutant{"hardened/relaxed-drop",
           "a request that was given up is laid down by a swap that orders nothing",
           data_race,
           2,
           "release: the emulator has read the request before the kernel writes the next one",
           {.options = relaxed(&Orders::drop)}},
    Mutant{"hardened/relaxed-attach",
           "an emulator attaches by a swap that orders nothing",
           data_race,
           2,
           "release: what the one before has read, it has read before the kernel writes the next request",
           {.options = relaxed(&Orders::attach), .emulator_kills = 1}},
};

template <std::size_t index>
void register_mutant() {
  constexpr const Mutant& mutant = mutants[index];
  static const std::string corrected_name = std::string{mutant.name} + "-corrected";
  const ltsim::ShapeRegistration registration{
      mutant.name,
      corrected_name,
      {.finding = mutant.finding, .depth = mutant.depth, .tasks_count = 2, .cure = mutant.cure},
      mutant.description,
      [](ltsim::World& world) {
        HardenedExchange exchange = mutants[index].exchange;
        if (mutants[index].finding != data_race) exchange.only = mutants[index].finding;
        run_hardened_exchange(world, exchange);
      },
      [](ltsim::World& world) {
        HardenedExchange exchange = mutants[index].exchange;
        exchange.options.rules = {};
        exchange.options.orders = {};
        run_hardened_exchange(world, exchange);
      }};
}

template <std::size_t... indexes>
bool register_set_ups(std::index_sequence<indexes...>) {
  (register_set_up<indexes>(), ...);
  return true;
}

template <std::size_t... indexes>
bool register_mutants(std::index_sequence<indexes...>) {
  (register_mutant<indexes>(), ...);
  return true;
}

const bool registered = register_set_ups(std::make_index_sequence<set_ups.size()>{}) &&
                        register_mutants(std::make_index_sequence<mutants.size()>{});

}  // namespace

SCENARIO("hardened/m9-read-before-taken",
         "no rule is needed for it while sequences differ: the request is copied before it is taken") {
  // The copy may race with the next request; then the swap fails, and it is not looked at.
  world.allow_data_races();
  run_hardened_exchange(world, {.options = without(&Rules::take_before_read), .requests = 2});
}
