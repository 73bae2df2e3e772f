#include "kernel_mocks/modal_rules.hpp"

#include <algorithm>
#include <string_view>

namespace kernel_mocks {
namespace {

constexpr GTenths g0 = 0, g1 = 10, g2 = 20, g3 = 30, g4 = 40, g28 = 280, g30 = 300, g41 = 410, g42 = 420,
                  g43 = 430, g53 = 530, g64 = 640, g80 = 800, g92 = 920, g92_1 = 921, g92_2 = 922,
                  g92_3 = 923, g93 = 930;

const LexedWord* first_of(std::span<const LexedWord> words, std::string_view letters) noexcept {
  const auto found = std::ranges::find_if(words, [letters](const LexedWord& word) {
    return letters.find(word.letter) != std::string_view::npos;
  });
  return found == words.end() ? nullptr : &*found;
}

const LexedWord* g_word_of(std::span<const LexedWord> words, GGroup group) noexcept {
  const auto found = std::ranges::find_if(words, [group](const LexedWord& word) {
    return word.letter == 'G' && g_group(*g_tenths(word.value)) == group;
  });
  return found == words.end() ? nullptr : &*found;
}

/// @return whether `word` exists and is one of the codes
template <typename... Codes>
bool is_g(const LexedWord* word, Codes... codes) noexcept {
  return word != nullptr && ((*g_tenths(word->value) == codes) || ...);
}

NcError error_at(NcFault fault, std::uint32_t line, const LexedWord& word) {
  return {fault, line, word.text};
}

}  // namespace

/// What of a block the rules ask for; nullptr where the block has no such word.
struct ModalRules::BlockFacts {
  explicit BlockFacts(std::span<const LexedWord> all) noexcept
      : words{all},
        motion{g_word_of(all, GGroup::motion)},
        non_modal{g_word_of(all, GGroup::non_modal)},
        axis{first_of(all, "XYZABCUVW")},
        centre{first_of(all, "IJK")},
        radius{first_of(all, "R")},
        feed{first_of(all, "F")} {}

  /// G28, G30 and G92 take the axis words away from the motion.
  [[nodiscard]] bool axis_words_are_taken() const noexcept { return is_g(non_modal, g28, g30, g92); }
  [[nodiscard]] bool moves() const noexcept { return axis != nullptr && !axis_words_are_taken(); }
  /// The word to blame for a motion: its G code, or what continues the motion in force.
  [[nodiscard]] const LexedWord& motion_or_last() const noexcept {
    return motion != nullptr ? *motion : words.back();
  }

  std::span<const LexedWord> words;
  const LexedWord* motion;
  const LexedWord* non_modal;
  const LexedWord* axis;
  const LexedWord* centre;
  const LexedWord* radius;
  const LexedWord* feed;
};

std::optional<NcError> ModalRules::check(std::span<const LexedWord> words, std::uint32_t line) {
  const BlockFacts facts{words};
  take_modes(facts);
  if (auto error = check_motion(facts, line)) return error;
  if (auto error = check_users(facts, line)) return error;
  const bool moves_at_feed = is_arc(facts) || (motion_ == g1 && facts.moves());
  if (moves_at_feed && !feed_is_set_) {
    return error_at(NcFault::motion_without_feed, line, facts.motion_or_last());
  }
  return std::nullopt;
}

void ModalRules::take_modes(const BlockFacts& facts) noexcept {
  if (facts.motion != nullptr) motion_ = *g_tenths(facts.motion->value);
  if (const LexedWord* const mode = g_word_of(facts.words, GGroup::feed_mode)) {
    // A feed of one mode means something else in another: the program has to give it anew.
    if (!is_g(mode, feed_mode_)) feed_is_set_ = false;
    feed_mode_ = *g_tenths(mode->value);
  }
  if (facts.feed != nullptr) {
    feed_is_set_ = !facts.feed->value.is_zero();
  } else if (feed_mode_ == g93) {
    feed_is_set_ = false;
  }
}

// A full circle has a centre and no axis words; a G2 or G3 alone is an arc that lacks everything.
bool ModalRules::is_arc(const BlockFacts& facts) const noexcept {
  if ((motion_ != g2 && motion_ != g3) || facts.axis_words_are_taken()) return false;
  return facts.axis != nullptr || facts.centre != nullptr || facts.radius != nullptr ||
         facts.motion != nullptr;
}

std::optional<NcError> ModalRules::check_motion(const BlockFacts& facts, std::uint32_t line) const {
  if (facts.axis != nullptr && facts.axis_words_are_taken() && facts.motion != nullptr && motion_ != g80) {
    return error_at(NcFault::two_users_of_axis_words, line, *facts.motion);
  }
  if (facts.moves() && motion_ == g80) {
    return error_at(NcFault::axis_words_without_motion, line, *facts.axis);
  }
  if (is_g(facts.non_modal, g53) && motion_ != g0 && motion_ != g1) {
    return error_at(NcFault::machine_coordinates_without_line, line, *facts.non_modal);
  }
  if (is_g(facts.non_modal, g4, g92_1, g92_2, g92_3) && (facts.moves() || is_arc(facts))) {
    return error_at(NcFault::motion_in_block_without, line, *facts.non_modal);
  }
  if (is_arc(facts) && (facts.radius != nullptr) == (facts.centre != nullptr)) {
    return error_at(NcFault::arc_without_centre, line, facts.motion_or_last());
  }
  if (is_g(facts.non_modal, g4)) {
    const LexedWord* const time = first_of(facts.words, "P");
    if (time == nullptr || time->value.is_negative()) {
      return error_at(NcFault::dwell_without_time, line, *facts.non_modal);
    }
  }
  return std::nullopt;
}

std::optional<NcError> ModalRules::check_users(const BlockFacts& facts, std::uint32_t line) const {
  const LexedWord* const compensation = g_word_of(facts.words, GGroup::cutter_compensation);
  const bool has_tolerance = is_g(g_word_of(facts.words, GGroup::path_control), g64);
  const bool arc = is_arc(facts);
  struct Use {
    std::string_view letters;
    bool is_used;
  };
  for (const Use& use : {Use{"IJKR", arc}, Use{"P", arc || has_tolerance || is_g(facts.non_modal, g4)},
                         Use{"Q", has_tolerance}, Use{"D", is_g(compensation, g41, g42)},
                         Use{"H", is_g(g_word_of(facts.words, GGroup::tool_length), g43)}}) {
    const LexedWord* const word = first_of(facts.words, use.letters);
    if (word != nullptr && !use.is_used) return error_at(NcFault::word_without_user, line, *word);
  }
  return std::nullopt;
}

}  // namespace kernel_mocks
