// Values as bytes, from a process to one that it was forked from: both have the same types, in the same layout.
//
// A type that is more than its bytes says once what is to be carried, for both directions:
//
//     template <typename Carrier>
//     void carry(Carrier& carrier, Deviation& deviation) {
//       carrier(deviation.anchor, deviation.answer);
//     }
#pragma once

#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "sim_clock/check/self_check.hpp"

namespace ltsim {

/// What the two directions have in common: which values are made of which.
template <typename Direction>
class Carrier {
 public:
  template <typename... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }

 private:
  template <typename Value>
  void one(Value& value) {
    if constexpr (std::is_trivially_copyable_v<Value>) {
      direction().bytes(&value, sizeof value);
    } else {
      carry(direction(), value);
    }
  }
  void one(std::string& text) { row(text); }
  template <typename Value>
  void one(std::vector<Value>& values) {
    if constexpr (std::is_trivially_copyable_v<Value>) {
      row(values);
    } else {
      std::size_t count = values.size();
      one(count);
      values.resize(count);
      for (Value& value : values) one(value);
    }
  }
  template <typename Value>
  void one(std::optional<Value>& value) {
    bool is_there = value.has_value();
    one(is_there);
    if (is_there && !value) value = Value{};
    if (is_there) one(*value);
  }
  template <typename First, typename Second>
  void one(std::pair<First, Second>& pair) {
    one(pair.first);
    one(pair.second);
  }
  template <typename Row>
  void row(Row& values) {
    std::size_t count = values.size();
    one(count);
    values.resize(count);
    direction().bytes(values.data(), count * sizeof(values[0]));
  }

  [[nodiscard]] Direction& direction() noexcept { return static_cast<Direction&>(*this); }
};

/// Values become bytes.
class BytesOut final : public Carrier<BytesOut> {
 public:
  /// @param room  more than that is an internal error
  explicit BytesOut(std::span<std::byte> room) noexcept : room_(room) {}

  void bytes(const void* from, std::size_t count) {
    LTSIM_CHECK(count <= room_.size() - used_);
    if (count != 0) std::memcpy(room_.data() + used_, from, count);
    used_ += count;
  }

 private:
  std::span<std::byte> room_;
  std::size_t used_ = 0;
};

/// Bytes become values again.
class BytesIn final : public Carrier<BytesIn> {
 public:
  explicit BytesIn(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

  void bytes(void* into, std::size_t count) {
    LTSIM_CHECK(count <= bytes_.size() - used_);
    if (count != 0) std::memcpy(into, bytes_.data() + used_, count);
    used_ += count;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t used_ = 0;
};

}  // namespace ltsim
