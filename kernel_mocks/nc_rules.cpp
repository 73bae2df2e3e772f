#include "kernel_mocks/nc_rules.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace kernel_mocks {
namespace {

constexpr bool is_axis(char letter) noexcept {
  return std::string_view{"XYZABCUVW"}.find(letter) != std::string_view::npos;
}

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

// The G codes of one block by what they do with other words.
struct GCodesOfBlock {
  std::optional<GTenths> motion;
  std::optional<GTenths> axis_user;  // G28, G30 or G92: takes the axis words away from the motion
  bool dwell = false;
  bool path_tolerance = false;
  bool machine_coordinates = false;
  bool compensation = false;
  bool tool_length = false;
};

GCodesOfBlock g_codes_of(std::span<const LexedWord> words) noexcept {
  GCodesOfBlock result;
  for (const LexedWord& word : words) {
    if (word.letter != 'G') continue;
    const GTenths code = *g_tenths(word.value);
    if (g_group(code) == GGroup::motion) result.motion = code;
    if (code == 280 || code == 300 || code == 920) result.axis_user = code;
    if (code == 40) result.dwell = true;
    if (code == 640) result.path_tolerance = true;
    if (code == 530) result.machine_coordinates = true;
    if (code == 410 || code == 420) result.compensation = true;
    if (code == 430) result.tool_length = true;
  }
  return result;
}

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

std::optional<NcError> ModalRules::check(std::span<const LexedWord> words, std::uint32_t line) {
  const GCodesOfBlock codes = g_codes_of(words);
  const auto fault = [&](NcFault what, const LexedWord& word) { return NcError{what, line, word.text}; };
  const auto first_with = [&](auto predicate) {
    const auto found = std::ranges::find_if(words, predicate);
    return found == words.end() ? nullptr : &*found;
  };
  const auto letter = [&](char wanted) {
    return first_with([wanted](const LexedWord& word) { return word.letter == wanted; });
  };
  const LexedWord* const axis = first_with([](const LexedWord& word) { return is_axis(word.letter); });
  const LexedWord* const motion_word = first_with([](const LexedWord& word) {
    return word.letter == 'G' && g_group(*g_tenths(word.value)) == GGroup::motion;
  });

  if (codes.motion) motion_ = *codes.motion;
  for (const LexedWord& word : words) {
    if (word.letter == 'G' && g_group(*g_tenths(word.value)) == GGroup::feed_mode) {
      const bool inverse = *g_tenths(word.value) == 930;
      // A feed of one mode means nothing in another: the program has to give it anew.
      if (inverse != inverse_time_) feed_is_set_ = false;
      inverse_time_ = inverse;
    }
  }
  const LexedWord* const feed = letter('F');
  if (feed != nullptr) feed_is_set_ = !feed->value.is_zero();
  if (feed == nullptr && inverse_time_) feed_is_set_ = false;

  const bool motion_claims_axes = codes.motion && motion_ != 800;
  if (axis != nullptr && codes.axis_user && motion_claims_axes) {
    return fault(NcFault::two_users_of_axis_words, *motion_word);
  }
  const bool is_arc_mode = motion_ == 20 || motion_ == 30;
  const bool moves = axis != nullptr && !codes.axis_user;
  const LexedWord* const radius = letter('R');
  const LexedWord* const centre = first_with(
      [](const LexedWord& word) { return word.letter == 'I' || word.letter == 'J' || word.letter == 'K'; });
  // A full circle has a centre and no axis words.
  const bool is_arc =
      is_arc_mode && !codes.axis_user && (moves || centre != nullptr || radius != nullptr || codes.motion);

  if (moves && motion_ == 800) return fault(NcFault::axis_words_without_motion, *axis);
  if (codes.machine_coordinates && motion_ != 0 && motion_ != 10) {
    return NcError{NcFault::machine_coordinates_without_line, line, "G53"};
  }
  if (is_arc && (radius != nullptr) == (centre != nullptr)) {
    return fault(NcFault::arc_without_centre, motion_word != nullptr ? *motion_word : words.back());
  }
  if (codes.dwell && (letter('P') == nullptr || letter('P')->value.is_negative())) {
    return NcError{NcFault::dwell_without_time, line, "G4"};
  }
  const auto unused = [&](char wanted, bool used) {
    const LexedWord* const word = letter(wanted);
    return word != nullptr && !used ? word : nullptr;
  };
  for (const LexedWord* const word :
       {unused('I', is_arc), unused('J', is_arc), unused('K', is_arc), unused('R', is_arc),
        unused('P', codes.dwell || codes.path_tolerance || is_arc), unused('Q', codes.path_tolerance),
        unused('D', codes.compensation), unused('H', codes.tool_length)}) {
    if (word != nullptr) return fault(NcFault::word_without_user, *word);
  }
  const bool feed_move = is_arc || (motion_ == 10 && moves);
  if (feed_move && !feed_is_set_) {
    return fault(NcFault::motion_without_feed, motion_word != nullptr ? *motion_word : words.back());
  }
  return std::nullopt;
}

}  // namespace kernel_mocks
