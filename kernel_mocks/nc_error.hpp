// Why a part program is refused: a place, a word and a reason.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kernel_mocks {

enum class NcFault : std::uint8_t {
  // characters and words
  bad_character,
  expression,
  word_without_number,
  not_a_number,
  too_many_digits,
  comment_not_closed,
  comment_in_comment,
  comment_not_opened,
  skip_not_at_start,
  text_after_percent,
  number_not_first,
  // words by themselves
  bad_block_number,
  bad_m_code,
  negative_feed,
  negative_speed,
  bad_tool_number,
  bad_offset_number,
  o_word,
  letter_without_meaning,
  unknown_g_code,
  canned_cycle,
  surface_speed,
  subprogram_call,
  // words of one block together
  repeated_word,
  g_codes_of_one_group,
  m_codes_of_one_group,
  too_many_m_codes,
  two_users_of_axis_words,
  machine_coordinates_without_line,
  motion_in_block_without,
  word_without_user,
  dwell_without_time,
  // blocks together
  motion_without_feed,
  axis_words_without_motion,
  arc_without_centre,
  // the whole
  line_too_long,
  too_many_blocks,
  no_program_end,
  // what this machine has
  m_code_not_in_machine_table,
  does_not_fit_plc_word,
  beyond_axis_limit,
  arc_radius_too_small,
  arc_end_off_circle,
  feed_per_revolution_without_speed,
  motion_too_long,
};

/// The reason as a sentence without a full stop, limits included.
[[nodiscard]] std::string_view to_string(NcFault fault) noexcept;

struct NcError {
  NcFault fault = NcFault::bad_character;
  /// Line of the file, from 1.
  std::uint32_t line = 0;
  /// The word as written, or the character; empty where the fault is not a word's.
  std::string word;

  bool operator==(const NcError&) const = default;
};

/// "line 12, word 'M3.5': an M code is a whole number from 0 to 199"
[[nodiscard]] std::string to_string(const NcError& error);

}  // namespace kernel_mocks
