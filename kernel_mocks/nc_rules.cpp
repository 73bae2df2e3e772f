#include "kernel_mocks/nc_rules.hpp"

#include <array>
#include <utility>

#include "kernel_mocks/g_codes.hpp"

namespace kernel_mocks {
namespace {

// M codes that cannot stand in one block, as bits; an M code without bits is in conflict with itself only.
enum MGroup : unsigned { program_flow = 1, spindle = 2, coolant = 4, overrides = 8, clamp = 16 };

constexpr unsigned m_groups(std::int64_t code) noexcept {
  switch (code) {
    case 0:
    case 1:
    case 2:
    case 30:
    case 60:
    case 98:
    case 99:
      return program_flow;
    case 3:
    case 4:
    case 5:
    case 19:
      return spindle;
    case 7:
    case 8:
    case 9:
      return coolant;
    case 13:
    case 14:
      return spindle | coolant;
    case 10:
    case 11:
      return clamp;
    case 48:
    case 49:
      return overrides;
    default:
      return 0;
  }
}

std::optional<NcFault> check_g_code(Decimal value) noexcept {
  const auto code = g_tenths(value);
  if (!code) return NcFault::unknown_g_code;
  if (is_canned_cycle(*code)) return NcFault::canned_cycle;
  if (*code == 960) return NcFault::surface_speed;
  if (!g_group(*code)) return NcFault::unknown_g_code;
  return std::nullopt;
}

bool is_count(Decimal value) noexcept { return value.is_whole() && !value.is_negative(); }

}  // namespace

std::optional<NcFault> check_word(const LexedWord& word) noexcept {
  const Decimal value = word.value;
  switch (word.letter) {
    case ':':
    case 'N':
      return is_count(value) ? std::nullopt : std::optional{NcFault::bad_block_number};
    case 'M':
      return is_count(value) && value.whole() <= m_code_max ? std::nullopt
                                                            : std::optional{NcFault::bad_m_code};
    case 'F':
      return value.is_negative() ? std::optional{NcFault::negative_feed} : std::nullopt;
    case 'S':
      return value.is_negative() ? std::optional{NcFault::negative_speed} : std::nullopt;
    case 'T':
      return is_count(value) ? std::nullopt : std::optional{NcFault::bad_tool_number};
    case 'D':
    case 'H':
      return is_count(value) ? std::nullopt : std::optional{NcFault::bad_offset_number};
    case 'G':
      return check_g_code(value);
    case 'O':
      return NcFault::o_word;
    case 'E':
    case 'L':
      return NcFault::letter_without_meaning;
    default:
      return std::nullopt;
  }
}

std::optional<NcError> check_block(std::span<const LexedWord> words, std::uint32_t line) {
  std::array<bool, 256> letter_seen{};
  std::array<bool, g_group_count> g_group_seen{};
  std::array<bool, m_code_max + 1> m_code_seen{};
  unsigned m_groups_seen = 0;
  unsigned m_count = 0;
  const auto fault = [&](NcFault what, const LexedWord& word) { return NcError{what, line, word.text}; };

  for (std::size_t index = 0; index < words.size(); ++index) {
    const LexedWord& word = words[index];
    if (word.letter == 'G') {
      // The non-modal codes count as a group too: G28 beside G92 would be a guess.
      const auto group = static_cast<std::size_t>(*g_group(*g_tenths(word.value)));
      if (std::exchange(g_group_seen[group], true)) return fault(NcFault::g_codes_of_one_group, word);
    } else if (word.letter == 'M') {
      const auto code = static_cast<std::size_t>(word.value.whole());
      const unsigned groups = m_groups(word.value.whole());
      if (std::exchange(m_code_seen[code], true) || (m_groups_seen & groups) != 0) {
        return fault(NcFault::m_codes_of_one_group, word);
      }
      m_groups_seen |= groups;
      if (++m_count > m_codes_per_block_max) return fault(NcFault::too_many_m_codes, word);
      if (code == 98) return fault(NcFault::subprogram_call, word);
    } else {
      // The colon of an alignment block is its N.
      const char letter = word.letter == ':' ? 'N' : word.letter;
      if (std::exchange(letter_seen[static_cast<unsigned char>(letter)], true)) {
        return fault(NcFault::repeated_word, word);
      }
      if (letter == 'N' && index != 0) return fault(NcFault::number_not_first, word);
    }
  }
  return std::nullopt;
}

}  // namespace kernel_mocks
