#include "tests/scenarios/hardened/word_ghost.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace scenarios {
namespace {

using Ghost = HardenedWordGhost;
using Mover = Ghost::Mover;

struct Move {
  Mover mover;
  bool attaches;
  Ghost::Phase from;
  Ghost::Phase to;

  bool operator==(const Move&) const = default;
};

constexpr auto master = Mover::master;
constexpr auto slave = Mover::slave;

constexpr std::array table{
    Move{master, false, Ghost::idle, Ghost::request},     // publish
    Move{master, false, Ghost::request, Ghost::idle},     // withdraw
    Move{master, false, Ghost::busy, Ghost::orphan},      // give up
    Move{master, false, Ghost::response, Ghost::idle},    // the answer has been copied out
    Move{master, false, Ghost::lost, Ghost::idle},        // acknowledge
    Move{slave, false, Ghost::request, Ghost::busy},      // take
    Move{slave, false, Ghost::busy, Ghost::response},     // answer
    Move{slave, false, Ghost::orphan, Ghost::idle},       // the answer is dropped
    Move{slave, false, Ghost::idle, Ghost::down},         // orderly stop
    Move{slave, false, Ghost::request, Ghost::down},      // orderly stop, the request is dropped
    Move{slave, true, Ghost::raw, Ghost::idle},           // attaches from here on
    Move{slave, true, Ghost::down, Ghost::idle},          //
    Move{slave, true, Ghost::idle, Ghost::idle},          //
    Move{slave, true, Ghost::request, Ghost::idle},       //
    Move{slave, true, Ghost::orphan, Ghost::idle},        //
    Move{slave, true, Ghost::busy, Ghost::lost},          //
    Move{slave, true, Ghost::response, Ghost::response},  //
    Move{slave, true, Ghost::lost, Ghost::lost},          //
    Move{master, true, Ghost::idle, Ghost::idle},         //
    Move{master, true, Ghost::request, Ghost::idle},      //
    Move{master, true, Ghost::response, Ghost::idle},     //
    Move{master, true, Ghost::lost, Ghost::idle},         //
    Move{master, true, Ghost::busy, Ghost::orphan},       //
    Move{master, true, Ghost::orphan, Ghost::orphan},
};

std::string_view name_of(Ghost::Phase phase) {
  constexpr std::array<std::string_view, 8> names{"RAW",      "IDLE",   "REQUEST", "BUSY",
                                                  "RESPONSE", "ORPHAN", "LOST",    "DOWN"};
  return names[phase];
}

std::string text_of(std::uint32_t word) {
  return fmt::format("{}({},{})", name_of(Ghost::phase_of(word)), Ghost::generation_of(word),
                     Ghost::sequence_of(word));
}

}  // namespace

std::optional<std::string> HardenedWordGhost::moves(Mover mover, std::uint32_t from, std::uint32_t to) {
  const std::uint32_t found = std::exchange(word_, to);
  const auto said = [&](std::string_view what) {
    return fmt::format("the {} puts {} in the place of {}{}", mover == master ? "master" : "slave",
                       text_of(to), text_of(from), what);
  };
  if (found != from) return said(fmt::format(", and undoes {}", text_of(found)));
  const bool attaches = generation_of(from) != generation_of(to);
  if (attaches && generation_of(to) != (generation_of(from) + 1) % 8192)
    return said(": not the next generation");
  if (std::ranges::find(table, Move{mover, attaches, phase_of(from), phase_of(to)}) == table.end())
    return said(": not in the table");
  const bool publishes = phase_of(to) == request;
  if (!publishes && sequence_of(from) != sequence_of(to)) return said(": another sequence");
  return std::nullopt;
}

}  // namespace scenarios
