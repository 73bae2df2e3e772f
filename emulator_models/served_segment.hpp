// The segment that the emulator serves, from taking the role to removing the named objects.
//
// The emulator takes its own role lock first, so that there is one on a segment, whichever handoff it has. What it finds
// then was left by killed processes, unless a kernel is attached: it is removed. With a kernel attached it is joined, if it
// has the same handoff (an emulator that was killed and comes back); a segment of the other handoff is refused. In the
// published handoff the last request stands in what is joined; in the hardened one the attach has dropped it.
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "protocol/exchange_sides.hpp"
#include "protocol/handoff.hpp"
#include "protocol/role_lock.hpp"

namespace emulator_models {

/// One thread makes, opens and destroys it.
class ServedSegment {
 public:
  ServedSegment(const std::string& name, const protocol::HandoffOptions& options);
  ServedSegment(const ServedSegment&) = delete;
  ServedSegment& operator=(const ServedSegment&) = delete;
  /// Closes, removes the named objects, gives the role back. With the hardened handoff a kernel that is still attached keeps
  /// them, and removes them when it ends.
  ~ServedSegment();

  /// @return what to tell the user about objects that were found (empty: there were none); or why the segment
  ///         cannot be had
  [[nodiscard]] tl::expected<std::string, std::string> open();
  [[nodiscard]] protocol::ExchangeSlave& slave() noexcept { return *slave_; }
  /// What to tell the user, before the end, of a kernel that is still attached; empty: there is none.
  [[nodiscard]] std::string at_the_end() const;

 private:
  /// @return false: a kernel is attached
  bool remove_left_over(protocol::Handoff found) noexcept;

  std::string name_;
  protocol::HandoffOptions options_;
  protocol::RoleLock role_;
  protocol::RoleLock kernel_role_;
  std::unique_ptr<protocol::ExchangeSlave> slave_;
};

}  // namespace emulator_models
