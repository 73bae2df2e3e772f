#include "tests/protocol/test_segment.hpp"

#include <atomic>
#include <cstring>

#include <boost/interprocess/shared_memory_object.hpp>
#include <boost/interprocess/sync/named_semaphore.hpp>

#include <unistd.h>

#include "protocol/shared_memory_wrapper.hpp"

namespace protocol {

namespace ipc = boost::interprocess;

namespace {

std::string unique_name() {
  static std::atomic<unsigned> segments_count = 0;
  return "protocol-test-" + std::to_string(::getpid()) + "-" + std::to_string(++segments_count);
}

}  // namespace

TestSegment::TestSegment() : name_(unique_name()) { SharedMemoryWrapper::remove(name_); }
TestSegment::~TestSegment() { SharedMemoryWrapper::remove(name_); }

RawSegment::RawSegment(const std::string& name)
    : memory_(ipc::shared_memory_object(ipc::open_only, name.c_str(), ipc::read_write), ipc::read_write) {}

std::uint32_t RawSegment::word(std::size_t offset) const noexcept {
  std::uint32_t value = 0;
  std::memcpy(&value, static_cast<const char*>(memory_.get_address()) + offset, sizeof value);
  return value;
}

void RawSegment::set_word(std::size_t offset, std::uint32_t value) noexcept {
  std::memcpy(static_cast<char*>(memory_.get_address()) + offset, &value, sizeof value);
}

std::string RawSegment::text(std::size_t offset, std::size_t length_bytes) const {
  return {static_cast<const char*>(memory_.get_address()) + offset, length_bytes};
}

void RawSegment::set_text(std::size_t offset, std::string_view text) noexcept {
  std::memcpy(static_cast<char*>(memory_.get_address()) + offset, text.data(), text.size());
}

unsigned take_all_tokens(const std::string& segment_name) {
  ipc::named_semaphore semaphore(ipc::open_only, segment_name.c_str());
  unsigned tokens_count = 0;
  while (semaphore.try_wait()) ++tokens_count;
  return tokens_count;
}

PaperOptions small_options() {
  PaperOptions options;
  options.request_bytes_max = 8;
  options.response_bytes_max = 8;
  options.read_timeout = std::chrono::nanoseconds::zero();
  return options;
}

std::vector<std::byte> bytes(std::string_view text) {
  const auto view = std::as_bytes(std::span(text));
  return {view.begin(), view.end()};
}

std::string text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace protocol
