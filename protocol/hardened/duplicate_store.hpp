// The answer to the last request that was executed, so that the same request sent again, as a query, gets its answer
// and is not executed once more.
//
// One entry is enough: a master sends a request again only before its next one, and within a session no sequence number
// is used for another request. The store dies with its slave; the generation of the state word tells the master so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace protocol::hardened {

class DuplicateStore {
 public:
  /// @param message_bytes_max  of the longest answer, with its header; put() then allocates nothing
  explicit DuplicateStore(std::size_t message_bytes_max) { answer_.reserve(message_bytes_max); }

  /// The request was executed; its answer takes the place of the last one.
  void put(std::uint64_t session, std::uint64_t sequence, std::span<const std::byte> answer) {
    session_ = session;
    sequence_ = sequence;
    answer_.assign(answer.begin(), answer.end());
    is_empty_ = false;
  }

  /// @return the answer, valid until the next put(); nothing unless this is the request that was executed last
  [[nodiscard]] std::optional<std::span<const std::byte>> find(std::uint64_t session,
                                                               std::uint64_t sequence) const noexcept {
    if (is_empty_ || session != session_ || sequence != sequence_) return std::nullopt;
    return std::span(answer_);
  }

 private:
  bool is_empty_ = true;
  std::uint64_t session_ = 0;
  std::uint64_t sequence_ = 0;
  std::vector<std::byte> answer_;
};

}  // namespace protocol::hardened
