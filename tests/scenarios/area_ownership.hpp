// Who is in an area of the segment at the moment (I7).
//
// A side is in an area from the event that lets it in to the event that lets it out: the master writes a
// request from `submitted` to `published` and reads a response from `accepted` to `delivered`; the slave reads
// a request from `taken` to `executed` and writes a response from `executed` to `answered`. Whatever the state
// word says, of two that are in one area at once, one of them writing, one is not its owner.
//
// Not seen: what lies outside these spans, such as a request that is sent again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <boost/container/static_vector.hpp>

#include "sim_clock/world/world.hpp"

namespace scenarios {

class AreaOwnership {
 public:
  enum class Use : std::uint8_t { writes_request, reads_request, writes_response, reads_response };

  explicit AreaOwnership(const ltsim::World& world) : world_(world) {}

  /// The task begins to use an area; what it used before it has left.
  void enters(ltsim::TaskId task, Use use);
  void leaves(ltsim::TaskId task) noexcept;
  /// Who was killed has left.
  void forget_killed() noexcept;

  /// Whether somebody else was in the area, one of the two writing, since the task entered it.
  [[nodiscard]] bool is_disturbed(ltsim::TaskId task) const noexcept;
  /// The first time that two were in one area, for a message; nothing if that never was.
  [[nodiscard]] const std::optional<std::string>& first_conflict() const noexcept { return first_conflict_; }

 private:
  struct Visit {
    ltsim::TaskId task;
    Use use;
    bool disturbed = false;
  };

  const ltsim::World& world_;
  /// By task, whoever came first; more tasks than any scenario has.
  boost::container::static_vector<Visit, 8> visits_;
  std::optional<std::string> first_conflict_;
};

}  // namespace scenarios
