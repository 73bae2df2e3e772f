// The coding of the state word, and what an attach makes of it.

#include <gtest/gtest.h>

#include <array>

#include "protocol/hardened/state_word.hpp"

namespace protocol::hardened {
namespace {

constexpr std::array phases{Phase::raw,      Phase::idle,   Phase::request, Phase::busy,
                            Phase::response, Phase::orphan, Phase::lost,    Phase::down};

TEST(StateWord, has_the_phase_below_the_generation_below_the_sequence) {
  EXPECT_EQ(encode({}), 0U);
  EXPECT_EQ(encode({Phase::busy, 0, 0}), 3U);
  EXPECT_EQ(encode({Phase::raw, 1, 0}), 8U);
  EXPECT_EQ(encode({Phase::raw, 0x1FFF, 0}), 0xFFF8U);
  EXPECT_EQ(encode({Phase::raw, 0, 1}), 0x1'0000U);
  EXPECT_EQ(encode({Phase::down, 0x1FFF, 0xFFFF}), 0xFFFF'FFFFU);
}

TEST(StateWord, is_what_was_encoded_for_each_phase_and_at_both_ends_of_each_number) {
  for (const Phase phase : phases) {
    for (const std::uint16_t generation : std::array<std::uint16_t, 3>{0, 1, 0x1FFF}) {
      for (const std::uint16_t sequence : std::array<std::uint16_t, 3>{0, 1, 0xFFFF}) {
        const StateWord word{phase, generation, sequence};
        EXPECT_EQ(decode(encode(word)), word);
      }
    }
  }
}

TEST(StateWord, is_told_by_each_value_of_32_bits) {
  for (const std::uint32_t value : {0x0U, 0x7U, 0xFFFF'FFFFU, 0x8000'0000U, 0xA5A5'A5A5U})
    EXPECT_EQ(encode(decode(value)), value);
}

TEST(StateWord, takes_the_low_16_bits_of_the_sequence_when_it_is_published) {
  const StateWord idle{Phase::idle, 5, 7};
  EXPECT_EQ(idle.publishing(8), (StateWord{Phase::request, 5, 8}));
  EXPECT_EQ(idle.publishing(0xFFFF), (StateWord{Phase::request, 5, 0xFFFF}));
  EXPECT_EQ(idle.publishing(0x1'0000), (StateWord{Phase::request, 5, 0}));
}

TEST(StateWord, keeps_generation_and_sequence_in_another_phase) {
  EXPECT_EQ((StateWord{Phase::request, 5, 7}.in(Phase::busy)), (StateWord{Phase::busy, 5, 7}));
}

struct Attach {
  Phase before;
  Phase after;
};

TEST(Attach, of_a_slave_drops_what_nobody_took_loses_what_was_taken_and_keeps_an_answer) {
  constexpr std::array table{Attach{Phase::raw, Phase::idle},          Attach{Phase::idle, Phase::idle},
                             Attach{Phase::request, Phase::idle},      Attach{Phase::busy, Phase::lost},
                             Attach{Phase::response, Phase::response}, Attach{Phase::orphan, Phase::idle},
                             Attach{Phase::lost, Phase::lost},         Attach{Phase::down, Phase::idle}};
  for (const auto& [before, after] : table)
    EXPECT_EQ(after_slave_attach({before, 5, 7}), (StateWord{after, 6, 7})) << encode({before, 0, 0});
}

TEST(Attach, of_a_master_ends_what_was_asked_and_orphans_what_is_taken) {
  constexpr std::array table{Attach{Phase::idle, Phase::idle},     Attach{Phase::request, Phase::idle},
                             Attach{Phase::busy, Phase::orphan},   Attach{Phase::response, Phase::idle},
                             Attach{Phase::orphan, Phase::orphan}, Attach{Phase::lost, Phase::idle}};
  for (const auto& [before, after] : table)
    EXPECT_EQ(after_master_attach({before, 5, 7}), (StateWord{after, 6, 7})) << encode({before, 0, 0});
}

TEST(Attach, of_a_master_changes_nothing_where_no_slave_serves) {
  for (const Phase phase : {Phase::raw, Phase::down}) {
    const StateWord word{phase, 5, 7};
    EXPECT_EQ(after_master_attach(word), word);
  }
}

TEST(Attach, wraps_the_generation_and_nothing_else) {
  const StateWord last{Phase::idle, StateWord::generation_max, 0xFFFF};
  EXPECT_EQ(after_slave_attach(last), (StateWord{Phase::idle, 0, 0xFFFF}));
  EXPECT_EQ(after_master_attach(last), (StateWord{Phase::idle, 0, 0xFFFF}));
}

}  // namespace
}  // namespace protocol::hardened
