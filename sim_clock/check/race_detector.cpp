#include "sim_clock/check/race_detector.hpp"

#include <sys/mman.h>

#include <bit>
#include <utility>

#include "sim_clock/check/self_check.hpp"

namespace ltsim {
namespace {

constexpr unsigned granule_bytes = 8;
static_assert(tasks_max <= 256, "a cell keeps its task in one byte");

}  // namespace

RaceDetector::RaceDetector(const HappensBefore& order, std::size_t places_count)
    : order_(order), granules_bytes_(places_count / granule_bytes * sizeof(Granule)), cells_(256) {
  static_assert(sizeof(Cell) == 16 && sizeof(Granule) == 16);
  void* const memory = mmap(nullptr, granules_bytes_, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  LTSIM_CHECK(memory != MAP_FAILED);
  granules_ = static_cast<Granule*>(memory);
}

RaceDetector::~RaceDetector() { munmap(granules_, granules_bytes_); }

void RaceDetector::reset() noexcept {
  cells_count_ = 1;
  free_cell_ = none;
  race_.reset();
  if (++generation_ != 0) return;
  // Once in 2^32 executions: what is older than that must not seem to be of this one.
  madvise(granules_, granules_bytes_, MADV_DONTNEED);
  generation_ = 1;
}

RaceDetector::LastWrite RaceDetector::access(const SharedAccess& access) {
  Cell cell{
      .next = none,
      .ticks = access.ticks != 0 ? access.ticks : order_.now(access.task),
      .site = access.site,
      .task = static_cast<std::uint8_t>(access.task),
      .bytes_mask = 0,
      .flags = static_cast<std::uint8_t>((access.writes ? write_flag : 0) | (access.plain ? plain_flag : 0))};
  LastWrite last;
  const std::size_t begin = access.place;
  const std::size_t end = begin + access.bytes;
  for (std::size_t index = begin / granule_bytes; index * granule_bytes < end; ++index) {
    Granule& granule = granules_[index];
    if (granule.generation != generation_)
      granule = {.generation = generation_, .first = none, .write_site = 0, .write_task = LastWrite::nobody};
    if (index == begin / granule_bytes) last = {.task = granule.write_task, .site = granule.write_site};
    if (access.writes) {
      granule.write_task = access.task;
      granule.write_site = access.site;
    }
    const std::size_t granule_begin = index * granule_bytes;
    const unsigned not_before = begin > granule_begin ? 0xffU << (begin - granule_begin) : 0xffU;
    const unsigned not_after =
        end < granule_begin + granule_bytes ? 0xffU >> (granule_begin + granule_bytes - end) : 0xffU;
    cell.bytes_mask = static_cast<std::uint8_t>(not_before & not_after);
    access_granule(index, granule, cell);
  }
  return last;
}

bool RaceDetector::is_contended(const SharedAccess& access) const noexcept {
  const Ticks* const known = order_.known_to(access.task);
  for (std::size_t index = access.place / granule_bytes; index * granule_bytes < access.place + access.bytes;
       ++index) {
    const Granule& granule = granules_[index];
    if (granule.generation != generation_) continue;
    for (std::uint32_t number = granule.first; number != none; number = cells_[number].next) {
      const Cell& cell = cells_[number];
      if (cell.task == access.task || (!access.writes && (cell.flags & write_flag) == 0)) continue;
      const bool is_plain = access.plain || (cell.flags & plain_flag) != 0;
      if (is_plain ? cell.ticks > known[cell.task]
                   : !order_.is_ordered_by_family(cell.task, cell.ticks, access.task))
        return true;
    }
  }
  return false;
}

void RaceDetector::access_granule(std::size_t index, Granule& granule, Cell access) {
  const Ticks* const known = order_.known_to(access.task);
  std::uint32_t place = none;  // of the new cell: that of one it stands for
  std::uint32_t* link = &granule.first;
  while (*link != none) {
    const std::uint32_t number = *link;
    Cell& earlier = cells_[number];
    const bool ordered = earlier.ticks <= known[earlier.task];
    if (ordered && (earlier.bytes_mask & ~access.bytes_mask) == 0 && (earlier.flags & ~access.flags) == 0) {
      if (place == none) {
        place = number;
        link = &earlier.next;
      } else {
        *link = earlier.next;
        earlier.next = free_cell_;
        free_cell_ = number;
      }
      continue;
    }
    const bool racing = !ordered && (earlier.bytes_mask & access.bytes_mask) != 0 &&
                        (earlier.flags | access.flags) == racing_flags;
    if (racing && !race_) [[unlikely]]
      record(index, earlier, access);
    link = &earlier.next;
  }
  if (place == none) {
    place = take_cell();
    access.next = granule.first;
    granule.first = place;
  } else {
    access.next = cells_[place].next;
  }
  cells_[place] = access;
}

std::uint32_t RaceDetector::take_cell() {
  if (free_cell_ != none) return std::exchange(free_cell_, cells_[free_cell_].next);
  if (cells_count_ == cells_.size()) cells_.resize(2 * cells_.size());
  return cells_count_++;
}

void RaceDetector::record(std::size_t index, const Cell& one, const Cell& other) noexcept {
  const auto side = [](const Cell& cell) {
    return Race::Side{.task = cell.task,
                      .writes = (cell.flags & write_flag) != 0,
                      .plain = (cell.flags & plain_flag) != 0,
                      .site = cell.site};
  };
  const auto common = static_cast<unsigned>(one.bytes_mask & other.bytes_mask);
  Race race{.place = static_cast<SharedPlace>(index * granule_bytes +
                                              static_cast<unsigned>(std::countr_zero(common))),
            .bytes = static_cast<std::uint8_t>(std::popcount(common)),
            .one = side(one),
            .other = side(other)};
  // One race, one text, whichever access came first.
  if (race.one.writes == race.other.writes ? race.other.task < race.one.task : race.other.writes)
    std::swap(race.one, race.other);
  race_ = race;
}

}  // namespace ltsim
