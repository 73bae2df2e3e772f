// K6: what of an area is touched first. One thread cannot see that in the memory afterwards, so the memory is
// taken away: the first access then faults, and its address is the answer.

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <unistd.h>

#include "protocol/master_shared_memory_wrapper.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

constexpr std::uintptr_t page_bytes = 4096;
constexpr int request_length = 4;
constexpr int request_bytes = 8;
constexpr int response_length = 16;
constexpr int response_bytes = 20;

/// Makes every mapping of the segment inaccessible. The process exits with the offset of the first access.
void exit_with_the_offset_of_the_first_access(const std::string& segment_name) {
  struct sigaction fault = {};
  fault.sa_flags = SA_SIGINFO;
  fault.sa_sigaction = [](int, siginfo_t* where, void*) {
    ::_exit(static_cast<int>(reinterpret_cast<std::uintptr_t>(where->si_addr) % page_bytes));
  };
  ::sigaction(SIGSEGV, &fault, nullptr);
  std::ifstream mappings("/proc/self/maps");
  for (std::string line; std::getline(mappings, line);) {
    std::uintptr_t begin = 0;
    if (line.find("/dev/shm/" + segment_name) != std::string::npos &&
        std::sscanf(line.c_str(), "%lx", &begin) == 1)
      ::mprotect(reinterpret_cast<void*>(begin), page_bytes, PROT_NONE);
  }
}

struct Order {
  PaperOptions::AreaOrder order;
  int first_in_request;
  int first_in_response;
};

class AreaOrder : public testing::TestWithParam<Order> {
 protected:
  void SetUp() override {
    PaperOptions options = small_options();
    options.area_order = GetParam().order;
    options.read_wait = PaperOptions::ReadWait::immediately;
    master_.emplace(segment_.name(), options);
    slave_.emplace(segment_.name(), options);
    ASSERT_TRUE(master_->open());
    ASSERT_TRUE(slave_->open());
  }

  template <typename Step>
  void expect_first_access(int offset, Step step) {
    EXPECT_EXIT(
        {
          exit_with_the_offset_of_the_first_access(segment_.name());
          step();
        },
        testing::ExitedWithCode(offset), "");
  }

  TestSegment segment_;
  std::optional<MasterSharedMemoryWrapper> master_;
  std::optional<SlaveSharedMemoryWrapper> slave_;
};

TEST_P(AreaOrder, holds_for_writing_a_request) {
  expect_first_access(GetParam().first_in_request, [&] { static_cast<void>(master_->write(bytes("ask"))); });
}

TEST_P(AreaOrder, holds_for_reading_a_request) {
  expect_first_access(GetParam().first_in_request, [&] { static_cast<void>(slave_->read_request()); });
}

TEST_P(AreaOrder, holds_for_writing_a_response) {
  expect_first_access(GetParam().first_in_response, [&] { slave_->write_response(bytes("answer")); });
}

TEST_P(AreaOrder, holds_for_reading_a_response) {
  expect_first_access(GetParam().first_in_response, [&] {
    std::array<std::byte, 8> buffer{};
    static_cast<void>(master_->get_response(buffer));
  });
}

INSTANTIATE_TEST_SUITE_P(
    K6, AreaOrder,
    testing::Values(Order{PaperOptions::AreaOrder::length_first, request_length, response_length},
                    Order{PaperOptions::AreaOrder::bytes_first, request_bytes, response_bytes}));

}  // namespace
}  // namespace protocol
