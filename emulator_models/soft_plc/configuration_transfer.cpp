#include "emulator_models/soft_plc/configuration_transfer.hpp"

#include <utility>

#include "emulator_models/soft_plc/plc_configuration.hpp"

namespace emulator_models::soft_plc {

std::uint32_t crc32(std::string_view bytes) noexcept {
  constexpr std::uint32_t polynomial_reversed = 0xEDB88320;
  std::uint32_t sum = 0xFFFFFFFF;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1U) != 0 ? polynomial_reversed : 0);
  }
  return ~sum;
}

tl::expected<void, std::string> ConfigurationTransfer::serve(const Request& request) {
  const std::lock_guard lock{mutex_};
  return std::visit([this](const auto& asked) { return take(asked); }, request);
}

tl::expected<void, std::string> ConfigurationTransfer::take(const Begin& begin) {
  begin_ = {};
  text_.clear();
  if (begin.bytes == 0 || begin.bytes > configuration_bytes_max)
    return tl::unexpected{"a configuration has 1 to " + std::to_string(configuration_bytes_max) + " bytes"};
  begin_ = begin;
  return {};
}

tl::expected<void, std::string> ConfigurationTransfer::take(const Chunk& chunk) {
  if (begin_.bytes == 0) return tl::unexpected{std::string{"no transfer is under way; send begin first"}};
  if (chunk.offset != text_.size())
    return tl::unexpected{"the next chunk begins at byte " + std::to_string(text_.size())};
  if (chunk.bytes.size() > begin_.bytes - text_.size())
    return tl::unexpected{std::string{"the chunk goes beyond the length that begin has named"}};
  text_ += chunk.bytes;
  return {};
}

tl::expected<void, std::string> ConfigurationTransfer::take(const Commit& commit) {
  if (begin_.bytes != 0 && commit.sum != begin_.sum)
    return tl::unexpected{std::string{"another transfer has begun meanwhile; send all again"}};
  const Begin begin = std::exchange(begin_, {});
  const std::string text = std::exchange(text_, {});
  if (begin.bytes == 0) return tl::unexpected{std::string{"no transfer is under way; send begin first"}};
  if (text.size() != begin.bytes || crc32(text) != begin.sum)
    return tl::unexpected{std::string{"length or sum differ from what begin has named; send all again"}};
  return reload_(text);
}

}  // namespace emulator_models::soft_plc
