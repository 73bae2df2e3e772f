// A configuration that comes over the wire, in pieces: begin, chunks, commit. Whoever serves a wire hands each request to
// serve(), on its own thread, beside the gateway: no scan is held up.
//
// Invariants
//   I1  nothing happens to the PLC before commit, and then only if length and sum are those that begin has named.
//   I2  chunks come in order and without gaps; a chunk that comes again is refused and changes nothing.
//   I3  a new begin drops what was there: one transfer at a time, the latest one. Its memory is bounded.
//   I4  who commits gets his own text or a refusal, never that of another who has begun meanwhile: a commit names its sum.
// Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <variant>

#include <tl/expected.hpp>

namespace emulator_models::soft_plc {

/// CRC-32 of IEEE 802.3, as zip and Ethernet have it.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes) noexcept;

class ConfigurationTransfer {
 public:
  struct Begin {
    std::uint32_t bytes = 0;  ///< 1 to configuration_bytes_max
    std::uint32_t sum = 0;    ///< crc32 of the whole text
  };
  struct Chunk {
    std::uint32_t offset = 0;
    std::string_view bytes;
  };
  struct Commit {
    std::uint32_t sum = 0;  ///< that of begin
  };
  using Request = std::variant<Begin, Chunk, Commit>;
  /// What takes the text: ConfiguredPlc::reload.
  using Reload = std::function<tl::expected<void, std::string>(std::string_view text)>;

  explicit ConfigurationTransfer(Reload reload) : reload_{std::move(reload)} {}

  /// @return nothing; or why the request is refused. After a refused commit the transfer begins anew,
  ///         unless it is another's.
  [[nodiscard]] tl::expected<void, std::string> serve(const Request& request);

 private:
  [[nodiscard]] tl::expected<void, std::string> take(const Begin& begin);
  [[nodiscard]] tl::expected<void, std::string> take(const Chunk& chunk);
  [[nodiscard]] tl::expected<void, std::string> take(const Commit& commit);

  const Reload reload_;
  std::mutex mutex_;
  Begin begin_;       ///< guarded by mutex_; 0 bytes: no transfer is under way
  std::string text_;  ///< guarded by mutex_
};

}  // namespace emulator_models::soft_plc
