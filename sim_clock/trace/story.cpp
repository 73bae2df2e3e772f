#include "sim_clock/trace/story.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/explore/duration_text.hpp"
#include "sim_clock/trace/value_text.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

constexpr int of_deviation = 1000;
constexpr int of_verdict_side = 200;
constexpr int of_value_passed = 60;
constexpr int of_wait = 45;
constexpr int of_note = 40;
constexpr int of_synchronisation = 30;
constexpr int of_access = 20;
constexpr int of_own_business = 0;

bool is_own_business(const Operation& operation) noexcept {
  switch (operation.kind) {
    case OperationKind::clock_read:
    case OperationKind::sleep:
    case OperationKind::yield:
    case OperationKind::once:
    case OperationKind::static_init:
    case OperationKind::thread_start:
    case OperationKind::shm_open:
    case OperationKind::shm_status:
    case OperationKind::shm_resize:
    case OperationKind::shm_map:
    case OperationKind::shm_unmap:
    case OperationKind::sem_open:
    case OperationKind::sem_close:
      return true;
    default:
      return false;
  }
}

bool is_update(OperationKind kind) noexcept {
  return kind == OperationKind::atomic_exchange || kind == OperationKind::atomic_update;
}

std::string_view verb(OperationKind kind) noexcept {
  if (!is_memory_access(kind)) return to_string(kind);
  if (is_update(kind)) return "updates";
  return changes_memory(kind) ? "writes" : "reads";
}

/// "1 store is", "2 stores are"
std::string newer_stores(std::size_t count) {
  return fmt::format("{} store{}", count, count == 1 ? " is" : "s are");
}

}  // namespace

Story::Story(World& world, const Schedule& schedule)
    : world_(world), schedule_(schedule), anchors_(world, nullptr) {
  for (std::size_t i = 0; i < schedule.deviations.size(); ++i) {
    if (schedule.deviations[i].anchor == anchors_.anchor()) {
      events_.push_back({.kind = Event::Kind::deviation, .text = i});
    } else {
      deviations_at_[schedule.deviations[i].anchor].push_back(i);
    }
  }
}

void Story::stand_here(TaskId task) {
  const auto found = deviations_at_.find(anchors_.anchor());
  if (found == deviations_at_.end()) return;
  for (const std::size_t deviation : found->second) {
    events_.push_back({.kind = Event::Kind::deviation, .task = task, .at = world_.now(), .text = deviation});
  }
  deviations_at_.erase(found);
}

void Story::arrives(const Task& task, const Operation& operation) noexcept {
  finish_write();
  anchors_.arrives(task, operation);
  stand_here(task.id);
}

void Story::performs(const Task& task, const Operation& operation) noexcept {
  finish_write();
  Event event{.task = task.id, .at = world_.now(), .operation = operation};
  if (is_memory_access(operation.kind)) {
    const std::uint64_t begin = std::uint64_t{operation.object} << 32U | operation.offset;
    if (operation.object != 0) event.before = event.after = world_.value_at(operation);
    const auto last = last_write_.find(begin);
    if (last != last_write_.end() && !(changes_memory(operation.kind) && !is_update(operation.kind))) {
      event.writer = events_[last->second].task;
      if (event.writer != task.id) events_[last->second].is_read_by_other = true;
    }
    if (changes_memory(operation.kind)) {
      before_last_write_.reset();
      if (last != last_write_.end()) before_last_write_ = last->second;
      for (std::uint64_t byte = 0; byte < operation.bytes; ++byte) last_write_[begin + byte] = events_.size();
      write_is_unfinished_ = true;
      unfinished_write_ = events_.size();
    }
  }
  events_.push_back(event);
}

void Story::blocks(const Task& task) noexcept {
  finish_write();
  events_.push_back({.kind = Event::Kind::waits,
                     .task = task.id,
                     .at = world_.now(),
                     .operation = world_.scheduler().pending(task)});
  anchors_.blocks(task);
  stand_here(task.id);
}

void Story::held_up(const Task& task, SimTime duration) noexcept {
  finish_write();
  anchors_.held_up(task, duration);
  stand_here(task.id);
}

void Story::goes_on(const Task& task) noexcept {
  finish_write();
  anchors_.goes_on(task);
}

void Story::ends(const Task& task) noexcept {
  finish_write();
  anchors_.ends(task);
  stand_here(task.id);
}

void Story::older(const Task& /*task*/, const OlderStore& taken) noexcept {
  Event& event = events_.back();
  const Operation& operation = event.operation;
  event.before = taken.found;
  event.after = taken.stored;
  event.newer_count = taken.newer_count;
  if (operation.kind != OperationKind::atomic_store) event.writer = taken.writer;
  if (!write_is_unfinished_) return;
  // What memory holds goes on to be another's.
  write_is_unfinished_ = false;
  const std::uint64_t begin = std::uint64_t{operation.object} << 32U | operation.offset;
  for (std::uint64_t byte = 0; byte < operation.bytes; ++byte) {
    if (before_last_write_) {
      last_write_[begin + byte] = *before_last_write_;
    } else {
      last_write_.erase(begin + byte);
    }
  }
}

void Story::asks(const Task* task, std::string_view what) noexcept {
  finish_write();
  anchors_.asks(task, what);
  stand_here(task == nullptr ? nobody : task->id);
}

void Story::notes(std::string_view text) noexcept {
  finish_write();
  events_.push_back({.kind = Event::Kind::note, .at = world_.now(), .text = notes_.size()});
  notes_.emplace_back(text);
}

void Story::finish_write() noexcept {
  if (!write_is_unfinished_) return;
  write_is_unfinished_ = false;
  Event& event = events_[unfinished_write_];
  if (event.operation.object != 0) event.after = world_.value_at(event.operation);
}

std::string Story::field(const Operation& operation) const {
  const std::string place = world_.objects().place(operation);
  return place.substr(0, place.find('['));
}

bool Story::joins(const Line& line, const Event& next) const {
  const Event& last = events_[line.events.back()];
  if (next.kind != Event::Kind::step || last.kind != Event::Kind::step || next.task != last.task ||
      next.operation.kind != last.operation.kind || next.writer != last.writer ||
      next.operation.object != last.operation.object)
    return false;
  if (!is_memory_access(next.operation.kind)) return true;
  if (is_update(next.operation.kind)) return false;
  const bool same_again = next.operation == last.operation && next.after == last.after;
  const bool next_bytes = next.operation.offset == last.operation.offset + last.operation.bytes &&
                          next.operation.object != 0 && field(next.operation) == field(last.operation);
  return same_again || next_bytes;
}

std::vector<Story::Line> Story::lines() const {
  std::vector<Line> all;
  for (std::size_t i = 0; i < events_.size(); ++i) {
    const Event& event = events_[i];
    // A loop that polls looks at clocks and sleeps between: what it looks at is one line all the same.
    const bool is_wait_for_time =
        event.kind == Event::Kind::waits && event.operation.kind == OperationKind::sleep;
    if (is_wait_for_time || (event.kind == Event::Kind::step && is_own_business(event.operation))) continue;
    if (!all.empty() && joins(all.back(), event)) {
      all.back().events.push_back(i);
    } else {
      all.push_back({.first = i, .events = {i}});
    }
  }
  return all;
}

void Story::weigh(std::vector<Line>& lines) const {
  constexpr int reach = 12;  // lines from a deviation at which it still adds weight
  for (Line& line : lines) {
    const Event& event = events_[line.first];
    const bool passes_value = std::any_of(line.events.begin(), line.events.end(), [&](std::size_t i) {
      return events_[i].is_read_by_other ||
             (events_[i].writer != nobody && events_[i].writer != events_[i].task);
    });
    line.weight = event.kind == Event::Kind::deviation ? of_deviation
                  : event.kind == Event::Kind::note    ? of_note
                  : event.kind == Event::Kind::waits   ? of_wait
                  : passes_value                       ? of_value_passed
                  : is_own_business(event.operation)   ? of_own_business
                  : is_memory_access(event.operation.kind)
                      ? (event.operation.object == 0 ? of_own_business : of_access)
                      : of_synchronisation;
  }
  std::vector<std::string> fields;  // that a deviation stands right before
  const auto touches_field = [&](const Line& line) {
    const Event& event = events_[line.first];
    return event.kind == Event::Kind::step && is_memory_access(event.operation.kind) &&
           event.operation.object != 0 &&
           std::find(fields.begin(), fields.end(), field(event.operation)) != fields.end();
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (events_[lines[i].first].kind != Event::Kind::deviation) continue;
    const TaskId task = events_[lines[i].first].task;
    const auto add_neighbour = [&](std::size_t at) {
      lines[at].weight += of_verdict_side;
      const Event& event = events_[lines[at].first];
      if (is_memory_access(event.operation.kind) && event.operation.object != 0)
        fields.push_back(field(event.operation));
    };
    // What the task did last before, what it does next when it goes on, and what runs in between at first.
    const auto is_step_of = [&](std::size_t at) {
      const Event& event = events_[lines[at].first];
      return event.task == task && event.kind == Event::Kind::step;
    };
    for (std::size_t at = i; at-- > 0;) {
      if (!is_step_of(at)) continue;
      add_neighbour(at);
      break;
    }
    for (std::size_t at = i + 1; at < lines.size(); ++at) {
      if (!is_step_of(at)) continue;
      add_neighbour(at);
      break;
    }
    for (int distance = 1; distance < reach; ++distance) {
      const auto step = static_cast<std::size_t>(distance);
      if (i + step < lines.size()) lines[i + step].weight += reach - distance;
      if (i >= step) lines[i - step].weight += reach - distance;
    }
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (touches_field(lines[i])) lines[i].weight += of_value_passed / 2;
    // The end is where the wrong value shows.
    if (i + reach >= lines.size()) lines[i].weight += 3 * static_cast<int>(i + reach - lines.size());
  }
}

std::string Story::describe(const Deviation& deviation) const {
  const std::size_t blank = deviation.anchor.find(' ');
  const std::string task = deviation.anchor.substr(0, blank);
  std::string place = deviation.anchor.substr(blank + 1);
  const bool at_start = place == "start";
  if (place.starts_with("before ")) place = "before its " + place.substr(7);
  switch (deviation.kind) {
    case Deviation::Kind::switch_task:
      if (at_start) return fmt::format("{} is the first to run", deviation.to_task);
      if (place == "end") return fmt::format("{} runs when {} has ended", deviation.to_task, task);
      if (place.starts_with("before its "))
        return fmt::format("{} is stopped {}; {} runs", task, place, deviation.to_task);
      return fmt::format("{} runs while {} is {}", deviation.to_task, task, place);
    case Deviation::Kind::pass_time:
      return fmt::format("{} pass for everybody, {} being {}", to_text(deviation.passes), task, place);
    case Deviation::Kind::stall:
      return fmt::format("{} is held up for {} {}", task, to_text(deviation.passes), place);
    case Deviation::Kind::fault:
      if (deviation.fault == FaultKind::crash)
        return fmt::format("{} is killed, {} being {}", deviation.process, task, place);
      return fmt::format("fault {} {} strikes {} {}", to_string(deviation.fault), deviation.answer, task,
                         place);
    case Deviation::Kind::choose:
      return fmt::format("{} answered with {}", task == "-" ? place : task + " " + place, deviation.answer);
    case Deviation::Kind::older:
      return fmt::format("{} {} {}: {} newer", task,
                         place.find(" atomic_store ") == std::string::npos ? "does not see the latest store"
                                                                           : "comes before others",
                         "at" + place.substr(place.find(' ')), newer_stores(deviation.answer));
  }
  return to_string(deviation);
}

std::string Story::describe(const Line& line) const {
  const Event& event = events_[line.first];
  if (event.kind == Event::Kind::deviation)
    return fmt::format("      -> {}\n", describe(schedule_.deviations[event.text]));
  const double us = static_cast<double>(event.at.count()) / 1000.0;
  if (event.kind == Event::Kind::note)
    return fmt::format("{:>14.3f}us  {:<18} {}\n", us, "", notes_[event.text]);
  const std::string& task = world_.scheduler().task(event.task).name;
  if (event.kind == Event::Kind::waits) {
    return fmt::format("{:>14.3f}us  {:<18} waits in {} {}\n", us, task, to_string(event.operation.kind),
                       world_.objects().name(event.operation));
  }
  const bool has_value = is_memory_access(event.operation.kind) && event.operation.object != 0;
  std::string text = world_.objects().place(event.operation);
  const Event& last = events_[line.events.back()];
  const bool is_row = has_value && line.events.size() > 1 && event.operation.offset != last.operation.offset;
  if (is_row) {
    const std::string end = world_.objects().place(last.operation);
    const std::size_t bracket = end.find('[');
    if (text.ends_with(']') && bracket != std::string::npos) {
      text.pop_back();
      text += ".." + end.substr(bracket + 1);
    }
  }
  if (has_value && is_update(event.operation.kind)) {
    text += fmt::format(": {} -> {}", value_text(world_, event.operation, event.before),
                        value_text(world_, event.operation, event.after));
  } else if (has_value) {
    text += changes_memory(event.operation.kind) ? " :=" : " =";
    constexpr std::size_t values_max = 4;
    const std::size_t values = is_row ? line.events.size() : 1;
    for (std::size_t i = 0; i < std::min(values, values_max); ++i)
      text.append(1, ' ').append(value_text(world_, event.operation, events_[line.events[i]].after));
    if (values > values_max) text += " ...";
  }
  if (!is_row && line.events.size() > 1) text += fmt::format(", {} times", line.events.size());
  if (event.newer_count != 0) {
    const bool only_stores = event.operation.kind == OperationKind::atomic_store;
    const std::string origin = only_stores ? std::string{}
                               : event.writer == nobody
                                   ? std::string{"it was there at first; "}
                                   : world_.scheduler().task(event.writer).name + " wrote that; ";
    text += fmt::format("   ({}{} newer)", origin, newer_stores(event.newer_count));
  } else if (event.writer != nobody && event.writer != event.task) {
    text += fmt::format("   ({} wrote that)", world_.scheduler().task(event.writer).name);
  }
  return fmt::format("{:>14.3f}us  {:<18} {:<8} {}\n", us, task, verb(event.operation.kind), text);
}

std::string Story::text(const Outcome& outcome) {
  finish_write();
  std::vector<Line> all = lines();
  weigh(all);
  constexpr std::size_t own_lines = 2;  // the first and the last
  std::vector<std::size_t> kept(all.size());
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = i;
  if (kept.size() > lines_max - own_lines) {
    std::sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
      return all[a].weight != all[b].weight ? all[a].weight > all[b].weight : a < b;
    });
    kept.resize(lines_max - own_lines);
    std::sort(kept.begin(), kept.end());
  }
  std::size_t steps_told = 0;
  std::string body;
  for (const std::size_t i : kept) {
    if (events_[all[i].first].kind == Event::Kind::step) steps_told += all[i].events.size();
    body += describe(all[i]);
  }
  const auto steps = static_cast<std::size_t>(std::count_if(
      events_.begin(), events_.end(), [](const Event& event) { return event.kind == Event::Kind::step; }));
  return fmt::format("  story: {} of {} steps\n{}      => {}{}{}, at {}\n", steps_told, steps, body,
                     to_string(outcome.kind), outcome.message.empty() ? "" : ": ", one_line(outcome.message),
                     to_text(world_.now()));
}

}  // namespace ltsim
