// Through the gateway field devices start an exchange with a cycle: read and write variables, from threads of their
// own, without ever holding up a scan.
//
// A request waits in the queue of its cycle until phase 1 (system analysis) of a scan; there all its items are
// carried out together, in their order, against the image that the scan before has left.
//
// Invariants
//   I1  items of one request see one image, and nothing comes between them.
//   I2  what is written in scan k was asked for before k began: no scan sees a write arrive in its middle.
//   I3  a request that was given up after its time is not carried out afterwards.
//   I4  per scan at most `requests_per_scan_max` requests are carried out, in the order of their arrival.
//   I5  carrying out a request takes no memory: the answer has got it when the request was taken.
// Any thread.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/cycle_body.hpp"
#include "emulator_models/soft_plc/il_program.hpp"
#include "emulator_models/soft_plc/inheriting_mutex.hpp"
#include "emulator_models/soft_plc/plc_observer.hpp"
#include "emulator_models/soft_plc/variable_exchange.hpp"

namespace emulator_models::soft_plc {

struct GatewayLimits {
  std::size_t queue_max = 32;             ///< requests waiting for one cycle; at least 1
  std::size_t requests_per_scan_max = 8;  ///< at least 1
};

struct GatewayItem {
  Area area = Area::memory;        ///< inputs, outputs or memory
  Section section;                 ///< for a write: only `first` counts
  std::vector<std::byte> written;  ///< empty: a read
  /// 0 to 7: a write of this bit alone; `written` is one byte, 0 = off. The other bits of the byte stay as they are.
  std::optional<std::uint8_t> bit{};
};

struct GatewayRequest {
  static constexpr std::size_t items_max = 16;
  static constexpr std::size_t bytes_max = 1024;  ///< of all items together

  std::size_t cycle = 0;
  std::vector<GatewayItem> items;
};

struct GatewayAnswer {
  std::uint64_t scan_number = 0;             ///< of the cycle's scans that have served requests or might have
  std::vector<std::vector<std::byte>> read;  ///< one for each item; empty for a write
};

enum class GatewayError : std::uint8_t {
  cycle_unknown,
  request_too_long,
  out_of_range,
  not_writable,
  bad_bit,
  owned_by_other_cycle,
  queue_full,
  timed_out,
  closed,
};
/// @return what is wrong and the way out
[[nodiscard]] std::string_view to_string(GatewayError error) noexcept;

class Gateway {
 public:
  using Result = tl::expected<GatewayAnswer, GatewayError>;
  class Ticket;

  /// @param images  of each cycle; only their sizes are looked at here
  Gateway(const GatewayLimits& limits, const std::vector<CycleImage>& images,
          const VariableExchange& exchange);
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  /// Waits for the answer.
  /// @param timeout  from 0 on
  [[nodiscard]] Result exchange(GatewayRequest request, std::chrono::nanoseconds timeout);

  /// The same in two steps, for whoever does not want to wait.
  [[nodiscard]] tl::expected<std::shared_ptr<Ticket>, GatewayError> submit(GatewayRequest request);
  /// @return timed_out while there is no answer: the request is given up, unless `keep_waiting`
  [[nodiscard]] Result take(const std::shared_ptr<Ticket>& ticket, bool keep_waiting = false);

  /// Phase 1 of a scan of that cycle, on its thread.
  /// @param observer  told of each write; may be null
  void serve(std::size_t cycle, const CycleImage& image, PlcObserver* observer = nullptr) noexcept;

  /// All requests that wait end as closed, later ones are refused.
  void close() noexcept;
  void set_limits(const GatewayLimits& limits) noexcept;
  [[nodiscard]] std::uint64_t refused_count() const noexcept;

 private:
  struct Cycle {
    std::array<std::size_t, areas_count> bytes{};
    std::vector<std::shared_ptr<Ticket>> queue;  ///< of a capacity that no scan has to extend
    std::uint64_t scan_number = 0;
  };
  [[nodiscard]] tl::expected<void, GatewayError> check(const GatewayRequest& request) const noexcept;
  [[nodiscard]] tl::expected<void, GatewayError> check_item(const GatewayItem& item,
                                                            std::size_t cycle) const noexcept;
  /// Of the requests that the scan is about to carry out.
  void tell_of_writes(std::size_t cycle, PlcObserver& observer) const noexcept;

  const VariableExchange& exchange_;
  mutable InheritingMutex mutex_;
  std::condition_variable answered_;
  // All guarded by mutex_.
  GatewayLimits limits_;
  std::vector<Cycle> cycles_;
  bool closed_ = false;
  std::uint64_t refused_count_ = 0;
};

}  // namespace emulator_models::soft_plc
