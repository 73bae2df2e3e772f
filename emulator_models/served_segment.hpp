// The segment that the emulator serves, from taking the role to removing the named objects.
//
// The published design lets the named objects of a killed process stand, and with them its last request. The
// emulator therefore looks first: it takes its own role lock, and objects that exist while nobody holds the
// kernel's are left over from killed processes and are removed. While a kernel runs, the emulator joins the
// objects as they are (an emulator that was killed and comes back).
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "protocol/paper_options.hpp"
#include "protocol/role_lock.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"

namespace emulator_models {

class ServedSegment {
 public:
  ServedSegment(const std::string& name, const protocol::PaperOptions& paper);
  ServedSegment(const ServedSegment&) = delete;
  ServedSegment& operator=(const ServedSegment&) = delete;
  /// Closes, removes the named objects, gives the role back.
  ~ServedSegment();

  /// @return what to tell the user about objects that were found (empty: there were none); or why the segment
  ///         cannot be had
  [[nodiscard]] tl::expected<std::string, std::string> open();
  [[nodiscard]] protocol::SlaveSharedMemoryWrapper& slave() noexcept { return slave_; }
  /// Whether a kernel is attached at this moment.
  [[nodiscard]] bool kernel_is_attached() const noexcept;

 private:
  std::string name_;
  protocol::RoleLock role_;
  protocol::RoleLock kernel_role_;
  protocol::SlaveSharedMemoryWrapper slave_;
};

}  // namespace emulator_models
