#include "kernel_mocks/nc_error.hpp"

#include <fmt/format.h>

namespace kernel_mocks {

std::string_view to_string(NcFault fault) noexcept {
  switch (fault) {
    case NcFault::bad_character:
      return "not a character of the ISO-7bit program code";
    case NcFault::expression:
      return "expressions, parameters and assignments ([ ] # = < >) are not supported";
    case NcFault::word_without_number:
      return "a word is a letter and a number";
    case NcFault::not_a_number:
      return "the number is a sign, digits and at most one decimal point";
    case NcFault::too_many_digits:
      return "a number has at most 9 digits before and 9 after the decimal point";
    case NcFault::comment_not_closed:
      return "the comment is not closed by ) in its line";
    case NcFault::comment_in_comment:
      return "a comment cannot contain (";
    case NcFault::comment_not_opened:
      return "a ) without its (";
    case NcFault::skip_not_at_start:
      return "the sign / of the optional block skip stands at the start of a block only";
    case NcFault::text_after_percent:
      return "after % only a program number or a comment may follow in the line";
    case NcFault::number_not_first:
      return "the block number is the first word of its block";
    case NcFault::bad_block_number:
      return "a block number is a whole number, not negative";
    case NcFault::bad_m_code:
      return "an M code is a whole number from 0 to 199";
    case NcFault::negative_feed:
      return "the feed is not negative";
    case NcFault::negative_speed:
      return "the spindle speed is not negative";
    case NcFault::bad_tool_number:
      return "a tool number is a whole number, not negative";
    case NcFault::bad_offset_number:
      return "an offset number is a whole number, not negative";
    case NcFault::o_word:
      return "O words (subroutines, branches, loops) are not supported; a program number stands alone in the "
             "first block";
    case NcFault::letter_without_meaning:
      return "no function of this control uses this letter";
    case NcFault::unknown_g_code:
      return "this control does not have this G code";
    case NcFault::canned_cycle:
      return "canned cycles are not supported";
    case NcFault::surface_speed:
      return "constant surface speed is not supported: the PLC would take S for revolutions per minute";
    case NcFault::subprogram_call:
      return "subprograms are not supported";
    case NcFault::repeated_word:
      return "this letter stands in the block twice";
    case NcFault::g_codes_of_one_group:
      return "another G code of the same modal group stands in the block";
    case NcFault::m_codes_of_one_group:
      return "another M code of the same group stands in the block";
    case NcFault::too_many_m_codes:
      return "a block has at most 4 M codes";
    case NcFault::two_users_of_axis_words:
      return "two G codes of the block claim its axis words";
    case NcFault::machine_coordinates_without_line:
      return "G53 needs G0 or G1";
    case NcFault::motion_in_block_without:
      return "G4 and G92.1 to G92.3 stand in a block that moves nothing";
    case NcFault::word_without_user:
      return "no G code of the block and no modal motion uses this word";
    case NcFault::dwell_without_time:
      return "G4 needs its time in seconds in a P word, not negative";
    case NcFault::motion_without_feed:
      return "G1, G2 and G3 need a feed greater than zero (with G93 in every block)";
    case NcFault::axis_words_without_motion:
      return "axis words without a motion: none of G0 to G3 is in force";
    case NcFault::arc_without_centre:
      return "G2 and G3 need a centre (I, J, K) or a radius (R), not both";
    case NcFault::line_too_long:
      return "a line has at most 512 characters";
    case NcFault::too_many_blocks:
      return "a program has at most 1000000 blocks";
    case NcFault::no_program_end:
      return "the file ends without M2, M30, M99 or a closing %: it may be cut off";
    case NcFault::m_code_not_in_machine_table:
      return "the machine has no such M function";
    case NcFault::does_not_fit_plc_word:
      return "the PLC takes whole numbers from 0 to 65535";
    case NcFault::beyond_axis_limit:
      return "the axis would leave its travel";
    case NcFault::arc_radius_too_small:
      return "the radius does not reach from the start of the arc to its end";
    case NcFault::arc_end_off_circle:
      return "the end of the arc does not lie on the circle through its start";
    case NcFault::feed_per_revolution_without_speed:
      return "a feed per revolution (G95) needs a spindle speed S greater than zero";
    case NcFault::motion_too_long:
      return "the motion would last longer than 24 hours";
  }
  return "unknown fault";
}

std::string to_string(const NcError& error) {
  if (error.word.empty()) return fmt::format("line {}: {}", error.line, to_string(error.fault));
  return fmt::format("line {}, word '{}': {}", error.line, error.word, to_string(error.fault));
}

}  // namespace kernel_mocks
