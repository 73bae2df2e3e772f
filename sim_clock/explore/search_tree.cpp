#include "sim_clock/explore/search_tree.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "sim_clock/check/self_check.hpp"

namespace ltsim {

class SearchTree::Part {
 public:
  enum class State : std::uint8_t { waits, is_searched, has_ended, is_over };

  Part* parent = nullptr;
  std::uint32_t depth = 0;  // decisions before it
  Decision begun;           // the last of these; not of the root
  SearchCounts counts;      // of what was searched while it was a leaf, and of the parts in it that are gone
  std::vector<TreeRequest> requests;  // to branches above it, in their order
  State state = State::waits;

  // A leaf.
  std::vector<Decision> rest;  // empty at first
  SearchedSlice ended;         // the last of it, if it has ended
  SearchCounts counts_now;     // of what the process that is at it has done
  double done_now = 0;

  // A branch.
  std::optional<Decision> branch;  // what was begun last is chosen
  unsigned gone = 0;               // choices that are over, and before all that are left
  std::vector<std::unique_ptr<Part>> parts;

  [[nodiscard]] bool is_over() const noexcept { return state == State::is_over; }

  /// Makes the leaf a branch, and the leaf the part of what is chosen there now.
  [[nodiscard]] Part& split() {
    branch = rest.front();
    gone = branch->alternatives_before();
    Part& below = begin(*branch);
    below.rest.assign(rest.begin() + 1, rest.end());
    rest.clear();
    return below;
  }

  Part& begin(const Decision& chosen) {
    parts.push_back(std::make_unique<Part>());
    Part& made = *parts.back();
    made.parent = this;
    made.depth = depth + 1;
    made.begun = chosen;
    return made;
  }
};

namespace {

using Part = SearchTree::Part;

/// The first one in the order of the tree that nobody is at, and the branch nearest to the root where something can be begun.
struct Search {
  Part* waiting = nullptr;
  Part* to_begin = nullptr;
  bool is_any_searched = false;

  /// @return false: nothing counts that comes after
  bool look_at(Part& part) {
    if (!part.branch) {
      if (part.state == Part::State::waits && waiting == nullptr) waiting = &part;
      is_any_searched = is_any_searched || part.state == Part::State::is_searched;
      return part.state != Part::State::has_ended;
    }
    for (const auto& each : part.parts) {
      if (!look_at(*each)) return false;
    }
    if (part.branch->has_next() && (to_begin == nullptr || part.depth < to_begin->depth)) to_begin = &part;
    return true;
  }
};

const Part* first_ended(const Part& part) noexcept {
  if (part.state == Part::State::has_ended) return &part;
  for (const auto& each : part.parts) {
    if (const Part* const found = first_ended(*each)) return found;
  }
  return nullptr;
}

/// @return false: what comes after does not count
bool add_counts(const Part& part, SearchCounts& to) noexcept {
  to += part.counts;
  if (part.state == Part::State::is_searched) to += part.counts_now;
  if (part.state == Part::State::has_ended) to += part.ended.counts;
  return part.state != Part::State::has_ended &&
         std::all_of(part.parts.begin(), part.parts.end(),
                     [&](const auto& each) { return add_counts(*each, to); });
}

double done_of_part(const Part& part) noexcept {
  if (part.is_over()) return 1;
  if (part.state == Part::State::is_searched) return part.done_now;
  if (!part.branch) return done_of(part.rest);
  double done = part.gone;
  for (const auto& each : part.parts) done += done_of_part(*each);
  return done / std::max(1U, part.branch->alternatives());
}

std::string counts_text(const SearchCounts& counts) {
  return fmt::format("{} executions, {} redundant, {} cut off, {} held back, {} points", counts.executions,
                     counts.redundant, counts.cut_off, counts.held_back, counts.points);
}

std::string requests_text(const std::vector<TreeRequest>& requests) {
  std::string text;
  for (const TreeRequest& request : requests)
    text += fmt::format("asks {} {:#x}\n", request.decision, request.any);
  return text;
}

std::string decisions_text(const std::vector<Decision>& decisions) {
  std::string text;
  for (const Decision& decision : decisions) text += to_string(decision) + '\n';
  return text;
}

std::string part_text(const Part& part) {
  std::string text = fmt::format("part {}\n{}", counts_text(part.counts), requests_text(part.requests));
  if (part.is_over()) return text + "over\n";
  if (!part.branch) return text + fmt::format("leaf {}\n{}", part.rest.size(), decisions_text(part.rest));
  text += fmt::format("branch {} {}\n{}\n", part.parts.size(), part.gone, to_string(*part.branch));
  for (const auto& each : part.parts) text += to_string(each->begun) + '\n' + part_text(*each);
  return text;
}

/// Reads lines; what is none of what is expected makes all that follows fail.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  [[nodiscard]] bool is_at_end() const noexcept { return text_.empty(); }
  [[nodiscard]] std::string_view rest() const noexcept { return text_; }

  [[nodiscard]] std::string next() {
    std::string line{text_.substr(0, text_.find('\n'))};
    text_.remove_prefix(std::min(line.size() + 1, text_.size()));
    return line;
  }
  [[nodiscard]] bool has(std::string_view beginning) const noexcept { return text_.starts_with(beginning); }

  [[nodiscard]] bool read(SearchCounts& counts, const char* before) {
    unsigned long long executions = 0, redundant = 0, cut_off = 0, held_back = 0, points = 0;
    const std::string format =
        fmt::format("{} %llu executions, %llu redundant, %llu cut off, %llu held back, %llu points", before);
    if (std::sscanf(next().c_str(), format.c_str(), &executions, &redundant, &cut_off, &held_back, &points) !=
        5)
      return false;
    counts = {.executions = executions,
              .redundant = redundant,
              .cut_off = cut_off,
              .held_back = held_back,
              .points = points};
    return true;
  }
  [[nodiscard]] bool read(std::vector<TreeRequest>& requests) {
    while (has("asks ")) {
      TreeRequest request;
      unsigned long long any = 0;
      if (std::sscanf(next().c_str(), "asks %u %llx", &request.decision, &any) != 2) return false;
      request.any = any;
      requests.push_back(request);
    }
    return true;
  }
  [[nodiscard]] bool read(std::vector<Decision>& decisions, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto decision = parse_decision(next());
      if (!decision) return false;
      decisions.push_back(*decision);
    }
    return true;
  }
  [[nodiscard]] bool read(Part& part);

 private:
  std::string_view text_;
};

bool Lines::read(Part& part) {
  if (!read(part.counts, "part") || !read(part.requests)) return false;
  const std::string kind = next();
  std::size_t count = 0;
  if (kind == "over") {
    part.state = Part::State::is_over;
    return part.parent != nullptr;  // a search that is over has no checkpoint
  }
  if (std::sscanf(kind.c_str(), "leaf %zu", &count) == 1) return read(part.rest, count);
  if (std::sscanf(kind.c_str(), "branch %zu %u", &count, &part.gone) != 2) return false;
  part.branch = parse_decision(next());
  if (!part.branch) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const auto begun = parse_decision(next());
    if (!begun || !read(part.begin(*begun))) return false;
  }
  return true;
}

}  // namespace

SearchCounts& SearchCounts::operator+=(const SearchCounts& other) noexcept {
  executions += other.executions;
  redundant += other.redundant;
  cut_off += other.cut_off;
  held_back += other.held_back;
  points += other.points;
  return *this;
}

std::string to_text(const SearchItem& item) {
  return fmt::format("settled {} of {}\n{}", item.settled, item.decisions.size(),
                     decisions_text(item.decisions));
}

std::optional<SearchItem> parse_item(std::string_view text) {
  Lines lines{text};
  SearchItem item;
  std::size_t count = 0;
  if (std::sscanf(lines.next().c_str(), "settled %zu of %zu", &item.settled, &count) != 2 ||
      item.settled > count || !lines.read(item.decisions, count) || !lines.is_at_end())
    return std::nullopt;
  return item;
}

std::string to_text(const SearchedSlice& slice) {
  return fmt::format("slice {}\n{}end {} {}\n{}{}", counts_text(slice.counts), requests_text(slice.requests),
                     static_cast<unsigned>(slice.end), slice.rest.size(), decisions_text(slice.rest),
                     slice.error);
}

std::optional<SearchedSlice> parse_slice(std::string_view text) {
  Lines lines{text};
  SearchedSlice slice;
  unsigned end = 0;
  std::size_t count = 0;
  if (!lines.read(slice.counts, "slice") || !lines.read(slice.requests) ||
      std::sscanf(lines.next().c_str(), "end %u %zu", &end, &count) != 2 ||
      end > static_cast<unsigned>(SliceEnd::in_error) || !lines.read(slice.rest, count))
    return std::nullopt;
  slice.end = static_cast<SliceEnd>(end);
  slice.error = lines.rest();
  return slice;
}

SearchTree::SearchTree() : root_(std::make_unique<Part>()) {}
SearchTree::~SearchTree() = default;
SearchTree::SearchTree(SearchTree&&) noexcept = default;
SearchTree& SearchTree::operator=(SearchTree&&) noexcept = default;

SearchTree::Part* SearchTree::take() {
  Search search;
  static_cast<void>(search.look_at(*root_));
  Part* found = search.waiting;
  if (found == nullptr && search.to_begin != nullptr) {
    Part& branch = *search.to_begin;
    LTSIM_CHECK(branch.branch->advance());
    found = &branch.begin(*branch.branch);
  }
  if (found != nullptr) {
    found->state = Part::State::is_searched;
    note_progress(*found, {}, done_of(found->rest));
  }
  return found;
}

SearchItem SearchTree::item_of(const Part& leaf) {
  SearchItem item;
  for (const Part* part = &leaf; part->parent != nullptr; part = part->parent)
    item.decisions.push_back(part->begun);
  std::reverse(item.decisions.begin(), item.decisions.end());
  item.settled = item.decisions.size();
  const auto& rest = leaf.state == Part::State::has_ended ? leaf.ended.rest : leaf.rest;
  item.decisions.insert(item.decisions.end(), rest.begin(), rest.end());
  return item;
}

void SearchTree::note_progress(Part& leaf, const SearchCounts& counts, double done) noexcept {
  leaf.counts_now = counts;
  leaf.done_now = done;
}

void SearchTree::give_back(Part& leaf, SearchedSlice slice, bool more_are_wanted) {
  LTSIM_CHECK(leaf.state == Part::State::is_searched);
  if (slice.end == SliceEnd::failed || slice.end == SliceEnd::in_error) {
    leaf.state = Part::State::has_ended;
    leaf.ended = std::move(slice);
    return;
  }
  leaf.state = slice.end == SliceEnd::over ? Part::State::is_over : Part::State::waits;
  leaf.counts += slice.counts;
  leaf.rest = std::move(slice.rest);
  for (const TreeRequest& request : slice.requests) add_request(leaf.requests, request);
  const bool can_be_split =
      !leaf.is_over() &&
      std::any_of(leaf.rest.begin(), leaf.rest.end(), [](const Decision& each) { return each.has_next(); });
  // What is over is gone after that.
  for (Part* part = leaf.parent; part != nullptr; part = part->parent) settle(*part);
  if (!more_are_wanted || !can_be_split) return;
  // Further down, parts become smaller, and there are more branches for requests to pass.
  Part* part = &leaf;
  for (bool goes_on = true; goes_on;) {
    goes_on = !part->rest.front().has_next();
    part = &part->split();
  }
}

/// Takes from the first of its parts what it asks for, and goes on to the next when that is over.
void SearchTree::settle(Part& branch) {
  const std::uint32_t own = branch.depth;
  while (!branch.parts.empty()) {
    Part& first = *branch.parts.front();
    for (const TreeRequest& request : first.requests) {
      if (request.decision == own) {
        static_cast<void>(branch.branch->must_try_one_of(request.any));
      } else {
        add_request(branch.requests, request);
      }
    }
    first.requests.clear();
    if (!first.is_over()) return;
    branch.counts += first.counts;
    ++branch.gone;
    branch.parts.erase(branch.parts.begin());
  }
  if (branch.branch->has_next()) return;
  branch.branch.reset();
  branch.state = Part::State::is_over;
}

bool SearchTree::is_complete() const noexcept { return root_->is_over(); }

const SearchTree::Part* SearchTree::ended() const noexcept { return first_ended(*root_); }

const SearchedSlice& SearchTree::end_of(const Part& leaf) noexcept { return leaf.ended; }

bool SearchTree::is_over() const noexcept {
  Search search;
  static_cast<void>(search.look_at(*root_));
  return search.waiting == nullptr && search.to_begin == nullptr && !search.is_any_searched;
}

SearchCounts SearchTree::counts() const noexcept {
  SearchCounts counts;
  static_cast<void>(add_counts(*root_, counts));
  return counts;
}

double SearchTree::done() const noexcept { return done_of_part(*root_); }

std::string SearchTree::checkpoint() const { return part_text(*root_); }

std::optional<SearchTree> SearchTree::parse(std::string_view checkpoint) {
  SearchTree tree;
  Lines lines{checkpoint};
  if (!lines.read(*tree.root_) || !lines.is_at_end()) return std::nullopt;
  return tree;
}

}  // namespace ltsim
