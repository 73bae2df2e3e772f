#include "tests/scenarios/litmus/axioms.hpp"

#include <algorithm>
#include <bitset>
#include <optional>
#include <stdexcept>

namespace litmus {
namespace {

constexpr std::size_t events_max = 16;
constexpr std::size_t none = events_max;

bool acquires(std::memory_order order) noexcept {
  return order == std::memory_order_acquire || order == std::memory_order_acq_rel ||
         order == std::memory_order_seq_cst;
}
bool releases(std::memory_order order) noexcept {
  return order == std::memory_order_release || order == std::memory_order_acq_rel ||
         order == std::memory_order_seq_cst;
}

/// A relation between events.
class Relation {
 public:
  void add(std::size_t a, std::size_t b) noexcept { rows_[a].set(b); }
  [[nodiscard]] bool holds(std::size_t a, std::size_t b) const noexcept { return rows_[a].test(b); }
  void close() noexcept {
    for (std::size_t k = 0; k < events_max; ++k) {
      for (auto& row : rows_) {
        if (row.test(k)) row |= rows_[k];
      }
    }
  }
  [[nodiscard]] bool is_irreflexive() const noexcept {
    for (std::size_t a = 0; a < events_max; ++a) {
      if (holds(a, a)) return false;
    }
    return true;
  }
  Relation& operator|=(const Relation& other) noexcept {
    for (std::size_t a = 0; a < events_max; ++a) rows_[a] |= other.rows_[a];
    return *this;
  }

 private:
  std::array<std::bitset<events_max>, events_max> rows_{};
};

struct Event {
  std::size_t task = 0;
  Step step;
  bool is_initial = false;
  // In one execution:
  bool reads = false;
  bool writes = false;
  std::uint32_t read = 0;
  std::uint32_t written = 0;
  std::memory_order order = std::memory_order_relaxed;
};

class Executions {
 public:
  explicit Executions(const Program& program) {
    for (std::size_t word = 0; word < words_count; ++word) {
      Event initial;
      initial.is_initial = true;
      initial.step.kind = Step::Kind::store;
      initial.step.word = word;
      events_.push_back(initial);
    }
    for (std::size_t task = 0; task < program.size(); ++task) {
      for (const Step& step : program[task]) {
        Event event;
        event.task = task;
        event.step = step;
        events_.push_back(event);
      }
    }
    if (events_.size() > events_max) throw std::invalid_argument{"a program of too many steps"};
    for (std::size_t a = 0; a < events_.size(); ++a) {
      for (std::size_t b = 0; b < events_.size(); ++b) {
        const bool both_of_tasks = !events_[a].is_initial && !events_[b].is_initial;
        // What is there at first was written before any task began.
        if (events_[a].is_initial ? !events_[b].is_initial
                                  : both_of_tasks && a < b && events_[a].task == events_[b].task)
          sequenced_before_.add(a, b);
      }
    }
    read_from_.assign(events_.size(), none);
  }

  [[nodiscard]] Allowed all() {
    choose_reads_from(0);
    return allowed_;
  }

 private:
  void choose_reads_from(std::size_t at) {
    while (at < events_.size() && !reads(events_[at].step.kind)) ++at;
    if (at == events_.size()) return judge_reads_from();
    for (std::size_t from = 0; from < events_.size(); ++from) {
      const Event& source = events_[from];
      const bool may_write = source.step.kind != Step::Kind::load && source.step.kind != Step::Kind::fence;
      if (from == at || !may_write || source.step.word != events_[at].step.word) continue;
      read_from_[at] = from;
      choose_reads_from(at + 1);
    }
    read_from_[at] = none;
  }

  void judge_reads_from() {
    // Values, from those that are known on. What then is unknown reads itself, over others: out of thin air.
    std::vector<bool> known(events_.size(), false);
    for (bool more = true; more;) {
      more = false;
      for (std::size_t i = 0; i < events_.size(); ++i) {
        if (known[i]) continue;
        Event& event = events_[i];
        const std::size_t from = read_from_[i];
        if (from != none && !known[from]) continue;
        evaluate(event, from == none ? 0 : events_[from].written);
        if (from != none && !events_[from].writes) return;
        known[i] = more = true;
      }
    }
    if (std::find(known.begin(), known.end(), false) != known.end()) return;
    for (auto& order : modifications_) order.clear();
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (events_[i].writes) modifications_[events_[i].step.word].push_back(i);
    }
    choose_modification_order(0);
  }

  static void evaluate(Event& event, std::uint32_t found) noexcept {
    const Step& step = event.step;
    event.reads = reads(step.kind);
    event.read = found;
    event.order = step.order;
    event.writes = step.kind == Step::Kind::store || step.kind == Step::Kind::add ||
                   (step.kind == Step::Kind::compare && found == step.expected);
    event.written = step.kind == Step::Kind::add ? found + step.value : step.value;
    if (step.kind == Step::Kind::compare && !event.writes) event.order = order_when_failing(step.order);
    if (event.is_initial) event.written = 0;
  }

  void choose_modification_order(std::size_t word) {
    if (word == words_count) return judge();
    auto& order = modifications_[word];
    std::sort(order.begin(), order.end());
    do {
      if (is_atomic(order)) choose_modification_order(word + 1);
      // What is there at first is first.
    } while (std::next_permutation(order.begin() + 1, order.end()));
  }

  /// An update reads what comes right before what it writes.
  [[nodiscard]] bool is_atomic(const std::vector<std::size_t>& order) const {
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (events_[order[i]].reads && (i == 0 || read_from_[order[i]] != order[i - 1])) return false;
    }
    return true;
  }

  [[nodiscard]] std::size_t place(std::size_t write) const {
    const auto& order = modifications_[events_[write].step.word];
    return static_cast<std::size_t>(std::find(order.begin(), order.end(), write) - order.begin());
  }

  void judge() {
    const Relation synchronises = synchronises_with();
    Relation happens = sequenced_before_;
    happens |= synchronises;
    happens.close();
    if (!happens.is_irreflexive()) return;
    const Relation coherence = coherence_ordered_before();
    for (std::size_t a = 0; a < events_.size(); ++a) {
      for (std::size_t b = 0; b < events_.size(); ++b) {
        if (happens.holds(a, b) && coherence.holds(b, a)) return;
      }
    }
    if (!has_total_order(synchronises, happens, coherence)) return;
    Relation causes = sequenced_before_;
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (read_from_[i] != none) causes.add(read_from_[i], i);
    }
    causes.close();
    Result result;
    for (const Event& event : events_) {
      if (event.reads) result.read.push_back(event.read);
    }
    for (std::size_t word = 0; word < words_count; ++word)
      result.words[word] = events_[modifications_[word].back()].written;
    (causes.is_irreflexive() ? allowed_.results : allowed_.by_load_buffering).insert(result);
  }

  /// [intro.races]/5: a release operation and the updates that follow it in the modification order.
  [[nodiscard]] bool is_in_release_sequence(std::size_t head, std::size_t write) const {
    const auto& order = modifications_[events_[head].step.word];
    for (std::size_t i = place(head); i < order.size(); ++i) {
      if (i != place(head) && !events_[order[i]].reads) return false;
      if (order[i] == write) return true;
    }
    return false;
  }

  /// [atomics.order]/2 and [atomics.fences]/2 to 4.
  [[nodiscard]] Relation synchronises_with() const {
    Relation relation;
    for (std::size_t load = 0; load < events_.size(); ++load) {
      if (!events_[load].reads) continue;
      const std::size_t seen = read_from_[load];
      for (std::size_t store = 0; store < events_.size(); ++store) {
        const Event& head = events_[store];
        if (!head.writes || head.is_initial || head.step.word != events_[load].step.word ||
            !is_in_release_sequence(store, seen))
          continue;
        for (std::size_t from = 0; from < events_.size(); ++from) {
          const bool hands_over = from == store ? releases(head.order)
                                                : is_fence(from) && releases(events_[from].step.order) &&
                                                      sequenced_before_.holds(from, store);
          if (!hands_over) continue;
          for (std::size_t to = 0; to < events_.size(); ++to) {
            const bool receives = to == load ? acquires(events_[load].order)
                                             : is_fence(to) && acquires(events_[to].step.order) &&
                                                   sequenced_before_.holds(load, to);
            if (receives) relation.add(from, to);
          }
        }
      }
    }
    return relation;
  }

  /// [atomics.order]/3.
  [[nodiscard]] Relation coherence_ordered_before() const {
    Relation relation;
    for (std::size_t a = 0; a < events_.size(); ++a) {
      for (std::size_t b = 0; b < events_.size(); ++b) {
        if (events_[a].step.word != events_[b].step.word || is_fence(a) || is_fence(b)) continue;
        if (events_[b].reads && read_from_[b] == a) relation.add(a, b);
        if (events_[a].writes && events_[b].writes && place(a) < place(b)) relation.add(a, b);
        if (events_[a].reads && events_[b].writes && a != b && place(read_from_[a]) < place(b))
          relation.add(a, b);
      }
    }
    relation.close();
    return relation;
  }

  /// [atomics.order]/4: whether there is an order S.
  [[nodiscard]] bool has_total_order(const Relation& synchronises, const Relation& happens,
                                     const Relation& coherence) const {
    Relation strongly = sequenced_before_;
    for (std::size_t a = 0; a < events_.size(); ++a) {
      for (std::size_t d = 0; d < events_.size(); ++d) {
        if (synchronises.holds(a, d) && is_seq_cst(a) && is_seq_cst(d)) strongly.add(a, d);
        for (std::size_t b = 0; b < events_.size(); ++b) {
          for (std::size_t c = 0; c < events_.size(); ++c) {
            if (sequenced_before_.holds(a, b) && happens.holds(b, c) && sequenced_before_.holds(c, d))
              strongly.add(a, d);
          }
        }
      }
    }
    strongly.close();
    Relation order;
    for (std::size_t a = 0; a < events_.size(); ++a) {
      for (std::size_t b = 0; b < events_.size(); ++b) {
        if (is_seq_cst(a) && is_seq_cst(b) && strongly.holds(a, b)) order.add(a, b);
        if (!coherence.holds(a, b)) continue;
        for (std::size_t x = 0; x < events_.size(); ++x) {
          const bool before = x == a ? is_seq_cst(a) : is_seq_cst_fence(x) && happens.holds(x, a);
          if (!before) continue;
          for (std::size_t y = 0; y < events_.size(); ++y) {
            const bool after = y == b ? is_seq_cst(b) : is_seq_cst_fence(y) && happens.holds(b, y);
            if (after) order.add(x, y);
          }
        }
      }
    }
    order.close();
    return order.is_irreflexive();
  }

  [[nodiscard]] bool is_fence(std::size_t event) const noexcept {
    return events_[event].step.kind == Step::Kind::fence;
  }
  [[nodiscard]] bool is_seq_cst(std::size_t event) const noexcept {
    return !events_[event].is_initial &&
           (is_fence(event) ? events_[event].step.order : events_[event].order) == std::memory_order_seq_cst;
  }
  [[nodiscard]] bool is_seq_cst_fence(std::size_t event) const noexcept {
    return is_fence(event) && is_seq_cst(event);
  }

  std::vector<Event> events_;
  Relation sequenced_before_;
  std::vector<std::size_t> read_from_;
  std::array<std::vector<std::size_t>, words_count> modifications_;
  Allowed allowed_;
};

}  // namespace

Allowed allowed_by_axioms(const Program& program) {
  Allowed allowed = Executions{program}.all();
  for (const Result& result : allowed.results) allowed.by_load_buffering.erase(result);
  return allowed;
}

}  // namespace litmus
