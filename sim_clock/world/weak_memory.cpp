#include "sim_clock/world/weak_memory.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

constexpr std::uint64_t mask_of(std::uint8_t bytes) noexcept {
  return bytes == 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << (bytes * 8U)) - 1;
}

std::uint64_t read_memory(const volatile void* address, std::uint8_t bytes) noexcept {
  switch (bytes) {
    case 1:
      return *static_cast<const volatile std::uint8_t*>(address);
    case 2:
      return *static_cast<const volatile std::uint16_t*>(address);
    case 4:
      return *static_cast<const volatile std::uint32_t*>(address);
    default:
      return *static_cast<const volatile std::uint64_t*>(address);
  }
}

void write_memory(const volatile void* address, std::uint8_t bytes, std::uint64_t value) noexcept {
  auto* const to = const_cast<volatile void*>(address);
  switch (bytes) {
    case 1:
      *static_cast<volatile std::uint8_t*>(to) = static_cast<std::uint8_t>(value);
      break;
    case 2:
      *static_cast<volatile std::uint16_t*>(to) = static_cast<std::uint16_t>(value);
      break;
    case 4:
      *static_cast<volatile std::uint32_t*>(to) = static_cast<std::uint32_t>(value);
      break;
    default:
      *static_cast<volatile std::uint64_t*>(to) = value;
  }
}

}  // namespace

void WeakMemory::reset() noexcept {
  if (!on_) return;
  on_ = false;
  watch_all_writes(false);
  locations_count_ = 0;
  may_hold_location_.fill(0);
  began_after_.fill(0);
  stores_ever_ = 1;
  seq_cst_.reset();
  if (++generation_ != 0) return;
  std::fill(slots_.begin(), slots_.end(), Slot{});
  generation_ = 1;
}

WeakMemory::Result WeakMemory::access(const Access& access) {
  Task& self = *current_task;
  if (is_seq_cst(access.order) || is_seq_cst(access.failure_order)) make_room_for_event();
  Location& location = location_of(access);
  list_options(location, access, self.id);
  std::size_t chosen = 0;
  if (options_.size() > 1) {
    ages_.clear();
    for (const Option& option : options_) ages_.push_back(option.age);
    chosen = world_.scheduler().choose_age(ages_, access.kind == AtomicAccess::store);
  }
  const Option option = options_[chosen];
  const TaskId writer = location.stores[location.stores.size() - 1 - option.age].writer;
  const Result result = carry_out(location, access, self.id, option);
  if (option.age != 0 && world_.scheduler().listener() != nullptr) {
    const std::uint64_t stored = !result.stored ? result.found
                                 : access.kind == AtomicAccess::store
                                     ? access.operand
                                     : access.change(result.found, access.operand);
    world_.scheduler().listener()->older(self, {.found = result.found,
                                                .stored = stored & mask_of(access.bytes),
                                                .writer = writer,
                                                .newer_count = option.age});
  }
  return result;
}

void WeakMemory::list_options(const Location& location, const Access& access, TaskId task) {
  options_.clear();
  const auto latest = static_cast<std::uint32_t>(location.stores.size() - 1);
  std::uint32_t oldest = oldest_visible(location, task);
  if (oldest != latest && access.kind == AtomicAccess::load) {
    const auto tired = [&](const Seen& seen) {
      return seen.task == task && seen.position != latest && seen.loads_in_a_row >= same_older_store_max;
    };
    if (std::any_of(location.seen.begin(), location.seen.end(), tired)) oldest = latest;
  }
  Events later = 0;
  for (std::uint32_t position = latest + 1; position-- > oldest;) {
    if (const auto option = option_at(location, access, task, position, later)) options_.push_back(*option);
    later |= location.stores[position].after;
  }
}

std::optional<WeakMemory::Option> WeakMemory::option_at(const Location& location, const Access& access,
                                                        TaskId task, std::uint32_t position,
                                                        Events later) const noexcept {
  const Store& store = location.stores[position];
  const auto latest = static_cast<std::uint32_t>(location.stores.size() - 1);
  Option option{
      .age = latest - position,
      .stores = access.kind != AtomicAccess::load && (!access.expected || *access.expected == store.value),
      .order = access.order,
      .before = 0,
      .fences = 0};
  if (option.stores && position != latest && location.stores[position + 1].is_update) return std::nullopt;
  if (access.kind == AtomicAccess::update && !option.stores) option.order = access.failure_order;
  HappensBefore& happens_before = world_.checks().order();
  const Ticks* const known = happens_before.known_to(task);
  const bool receives = access.kind != AtomicAccess::store && acquires(option.order) &&
                        store.handed_over != HappensBefore::nothing;
  option.fences =
      seq_cst_.fences_before(task, known, receives ? happens_before.covered_by(store.handed_over) : nullptr);
  if (is_seq_cst(option.order)) {
    Events before = location.dropped | store.of_store;
    if (option.stores) before |= store.of_loads;
    for (std::uint32_t older = 0; older < position; ++older)
      before |= location.stores[older].of_store | location.stores[older].of_loads;
    option.before = seq_cst_.before_next_of(task, known) | seq_cst_.with_predecessors(before);
  }
  if (later != 0 && ((option.before | seq_cst_.with_predecessors(option.fences)) & later) != 0)
    return std::nullopt;
  return option;
}

WeakMemory::Result WeakMemory::carry_out(Location& location, const Access& access, TaskId task,
                                         const Option& option) {
  const auto latest = static_cast<std::uint32_t>(location.stores.size() - 1);
  const std::uint32_t position = latest - option.age;
  const bool loads = access.kind != AtomicAccess::store;
  HappensBefore& happens_before = world_.checks().order();
  const HappensBefore::HandedOver found_with = location.stores[position].handed_over;
  const Ticks before = happens_before.now(task);
  if (loads) happens_before.load_receives(task, found_with, option.order);
  Store made;
  if (option.stores) {
    made.handed_over =
        happens_before.store_hands_over(task, option.order, loads ? found_with : HappensBefore::nothing);
  }
  const Events own =
      is_seq_cst(option.order)
          ? seq_cst_.add(task, {.happens = before, .strongly_happens = happens_before.now(task)}, false,
                         option.before)
          : Events{0};
  const Events events = own | option.fences;
  if (events != 0 && option.age != 0) {
    Events later = 0;
    for (std::uint32_t newer = position + 1; newer <= latest; ++newer) later |= location.stores[newer].after;
    seq_cst_.put_before(seq_cst_.with_predecessors(events), later);
  }
  Store& store = location.stores[position];
  const Result result{.found = store.value, .stored = option.stores, .ticks = before};
  if (loads) {
    store.of_loads |= events;
    store.after |= own;
  }
  if (!option.stores) {
    see(location, task, before, position, true);
    return result;
  }
  made.value =
      (loads ? access.change(result.found, access.operand) : access.operand) & mask_of(location.bytes);
  made.number = stores_ever_++;
  made.writer = task;
  made.is_update = loads;
  made.of_store = events;
  made.after = own;
  insert(location, position + 1, made);
  see(location, task, before, position + 1, false);
  if (position == latest) write_memory(access.address, location.bytes, made.value);
  constexpr std::size_t stores_between_clean_ups = 16;
  if (location.stores.size() % stores_between_clean_ups == 0) drop_oldest(location);
  return result;
}

std::uint32_t WeakMemory::oldest_visible(const Location& location, TaskId task) const noexcept {
  const Ticks* const known = world_.checks().order().known_to(task);
  std::uint32_t oldest = 0;
  for (const Seen& seen : location.seen) {
    if (seen.position > oldest && seen.ticks <= known[seen.task]) oldest = seen.position;
  }
  if (began_after_[task] != 0) {
    for (std::uint32_t i = oldest + 1; i < location.stores.size(); ++i) {
      if (location.stores[i].number < began_after_[task]) oldest = i;
    }
  }
  return oldest;
}

void WeakMemory::see(Location& location, TaskId task, Ticks ticks, std::uint32_t position, bool is_load) {
  for (std::size_t i = location.seen.size(); i-- > 0;) {
    Seen& seen = location.seen[i];
    if (seen.task != task) continue;
    if (seen.position == position) {
      if (is_load) ++seen.loads_in_a_row;
      return;
    }
    seen.loads_in_a_row = 0;
    if (seen.ticks != ticks) break;
    seen.position = position;
    seen.loads_in_a_row = is_load ? 1U : 0U;
    return;
  }
  location.seen.push_back(
      {.task = task, .ticks = ticks, .position = position, .loads_in_a_row = is_load ? 1U : 0U});
}

void WeakMemory::insert(Location& location, std::uint32_t position, const Store& store) {
  location.stores.insert(location.stores.begin() + position, store);
  for (Seen& seen : location.seen) {
    if (seen.position >= position) ++seen.position;
  }
}

void WeakMemory::drop_oldest(Location& location) {
  std::uint32_t dropped = static_cast<std::uint32_t>(location.stores.size() - 1);
  for (std::size_t i = 0; i < world_.scheduler().tasks_count(); ++i) {
    const Task& task = world_.scheduler().task(static_cast<TaskId>(i));
    if (task.state == Task::State::finished || task.state == Task::State::killed) continue;
    dropped = std::min(dropped, oldest_visible(location, task.id));
  }
  if (location.stores.size() - dropped > stores_max)
    dropped = static_cast<std::uint32_t>(location.stores.size() - stores_max);
  for (std::uint32_t i = 0; i < dropped; ++i) {
    const Store& store = location.stores[i];
    location.dropped |= store.of_store | store.of_loads;
    world_.checks().order().drop(store.handed_over);
  }
  location.stores.erase(location.stores.begin(), location.stores.begin() + dropped);
  std::erase_if(location.seen, [&](const Seen& seen) { return seen.position <= dropped; });
  for (Seen& seen : location.seen) seen.position -= dropped;
}

void WeakMemory::fence(TaskId task, int order) {
  HappensBefore& happens_before = world_.checks().order();
  if (!is_seq_cst(order)) {
    happens_before.fence(task, order);
    return;
  }
  make_room_for_event();
  Events before = seq_cst_.before_next_of(task, happens_before.known_to(task));
  const Ticks ticks_before = happens_before.now(task);
  happens_before.fence(task, order);
  // What happens before the fence, and what comes before that in some modification order, precedes it.
  Events found = 0;
  for (std::size_t i = 0; i < locations_count_; ++i) {
    const Location& location = locations_[i];
    const std::uint32_t seen = oldest_visible(location, task);
    found |= location.dropped | location.stores[seen].of_store;
    for (std::uint32_t older = 0; older < seen; ++older)
      found |= location.stores[older].of_store | location.stores[older].of_loads;
  }
  before |= seq_cst_.with_predecessors(found);
  const Events own = seq_cst_.add(
      task, {.happens = ticks_before, .strongly_happens = happens_before.now(task)}, true, before);
  for (std::size_t i = 0; i < locations_count_; ++i)
    locations_[i].stores[oldest_visible(locations_[i], task)].after |= own;
}

void WeakMemory::make_room_for_event() noexcept {
  if (!seq_cst_.is_full()) return;
  seq_cst_.shorten();
  for (std::size_t i = 0; i < locations_count_; ++i) {
    Location& location = locations_[i];
    location.dropped = SeqCstOrder::shortened(location.dropped);
    for (Store& store : location.stores) {
      store.of_store = SeqCstOrder::shortened(store.of_store);
      store.of_loads = SeqCstOrder::shortened(store.of_loads);
      store.after = SeqCstOrder::shortened(store.after);
    }
  }
}

WeakMemory::Location& WeakMemory::location_of(const Access& access) {
  const std::uint64_t key = Segments::canonical(access.address);
  Location* found = find(key);
  if (found == nullptr) found = &add_location(access, key);
  Location& location = *found;
  if (location.bytes != access.bytes) [[unlikely]] {
    world_.unsupported(
        fmt::format("{} accesses {} bytes atomically where {} bytes were accessed so before: memory c11 has "
                    "no mixed sizes",
                    current_task->name, access.bytes, location.bytes));
  }
  const std::uint64_t value = read_memory(access.address, access.bytes);
  if (location.was_written_plainly || value != location.stores.back().value) begin_history(location, value);
  return location;
}

void WeakMemory::begin_history(Location& location, std::uint64_t value) {
  for (const Store& store : location.stores) world_.checks().order().drop(store.handed_over);
  location.was_written_plainly = false;
  location.dropped = 0;
  location.seen.clear();
  location.stores.clear();
  location.stores.push_back({.value = value});
}

WeakMemory::Location& WeakMemory::add_location(const Access& access, std::uint64_t key) {
  for (std::uint64_t near = key & ~std::uint64_t{7}; near < key + access.bytes; ++near) {
    const Location* const other = near == key ? nullptr : find(near);
    if (other == nullptr || near + other->bytes <= key) continue;
    world_.unsupported(
        fmt::format("{} accesses {} bytes atomically that overlap {} bytes accessed so before: memory c11 "
                    "has no mixed sizes",
                    current_task->name, access.bytes, other->bytes));
  }
  if (2 * (locations_count_ + 1) > slots_.size()) grow();
  slots_[slot_of(key)] = {
      .key = key, .generation = generation_, .location = static_cast<std::uint32_t>(locations_count_)};
  const std::size_t bit = filter_bit(key);
  may_hold_location_[bit / 64] |= std::uint64_t{1} << (bit % 64);
  if (locations_count_ == locations_.size()) locations_.emplace_back();
  Location& location = locations_[locations_count_++];
  location.key = key;
  location.bytes = access.bytes;
  location.stores.clear();  // of another execution: nothing that it handed over is left
  begin_history(location, read_memory(access.address, access.bytes));
  return location;
}

void WeakMemory::forget_history(const volatile void* address, std::size_t bytes) noexcept {
  constexpr std::uint64_t granule = 8;
  const std::uint64_t begin = Segments::canonical(address);
  for (std::uint64_t at = begin / granule * granule; at < begin + bytes; at += granule) {
    const std::size_t bit = filter_bit(at);
    if ((may_hold_location_[bit / 64] >> (bit % 64) & 1) == 0) continue;
    for (std::uint64_t near = at; near < at + granule; ++near) {
      Location* const location = find(near);
      if (location != nullptr && near + location->bytes > begin && near < begin + bytes)
        location->was_written_plainly = true;
    }
  }
}

std::size_t WeakMemory::slot_of(std::uint64_t key) const noexcept {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = (key * 0x9e3779b97f4a7c15U) >> (64 - std::countr_zero(slots_.size()));
  while (slots_[slot].generation == generation_ && slots_[slot].key != key) slot = (slot + 1) & mask;
  return slot;
}

WeakMemory::Location* WeakMemory::find(std::uint64_t key) noexcept {
  const Slot& slot = slots_[slot_of(key)];
  return slot.generation == generation_ ? &locations_[slot.location] : nullptr;
}

void WeakMemory::grow() {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& slot : old) {
    if (slot.generation == generation_) slots_[slot_of(slot.key)] = slot;
  }
}

}  // namespace ltsim
