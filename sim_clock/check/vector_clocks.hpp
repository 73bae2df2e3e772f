// Vector clocks: rows of counters, one counter a task, that say how much of each task has happened before.
//
// Rows are pooled. Every operation costs as many counters as there are tasks,
// in whole vector registers; after the first executions nothing allocates.
//
// Invariants
//   I1  a row that is not taken holds zeros, and so does every counter from the width on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_clock/clock/virtual_clock.hpp"

namespace ltsim {

using Ticks = std::uint32_t;

class VectorClocks {
 public:
  using Row = std::uint32_t;

  /// Gives back all rows.
  void reset() noexcept {
    for (Row row = 0; row < taken_; ++row) clear(row);
    taken_ = 0;
    given_back_.clear();
    width_ = width_step;
  }

  /// From now on there is a task of that number.
  void make_room_for(TaskId task) noexcept {
    while (width_ <= task) width_ += width_step;
  }

  /// @return a row of zeros
  [[nodiscard]] Row take() {
    if (!given_back_.empty()) {
      const Row row = given_back_.back();
      given_back_.pop_back();
      return row;
    }
    if (counters_.size() < (taken_ + std::size_t{1}) * stride)
      counters_.resize(counters_.size() + 8 * stride);
    return taken_++;
  }

  /// The row is not needed any more.
  void give_back(Row row) {
    clear(row);
    given_back_.push_back(row);
  }

  [[nodiscard]] Ticks* at(Row row) noexcept { return counters_.data() + row * stride; }
  [[nodiscard]] const Ticks* at(Row row) const noexcept { return counters_.data() + row * stride; }

  void clear(Row row) noexcept { std::fill_n(at(row), width_, 0U); }
  void copy(Row into, Row from) noexcept { std::copy_n(at(from), width_, at(into)); }
  /// What has happened before one or the other.
  void join(Row into, Row from) noexcept {
    Ticks* const a = at(into);
    const Ticks* const b = at(from);
    for (std::size_t i = 0; i < width_; i += width_step) {
      for (std::size_t j = i; j < i + width_step; ++j) a[j] = std::max(a[j], b[j]);
    }
  }

 private:
  static constexpr std::size_t width_step = 8;
  // Rows that begin in different sets of the cache: a power of two would put all into a few.
  static constexpr std::size_t stride = tasks_max + 16;

  std::vector<Ticks> counters_;
  Row taken_ = 0;
  std::vector<Row> given_back_;
  std::size_t width_ = width_step;
};

}  // namespace ltsim
