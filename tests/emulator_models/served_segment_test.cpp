// The emulator's segment from its first look to the last object that it removes, with either handoff.
#include "emulator_models/served_segment.hpp"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>

#include "protocol/hardened/master.hpp"
#include "protocol/hardened/named_memory.hpp"
#include "protocol/hardened/slave.hpp"
#include "protocol/shared_memory_port.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/hardened/hardened_segment.hpp"
#include "tests/protocol/test_segment.hpp"

namespace emulator_models {
namespace {

using protocol::Handoff;
using protocol::HandoffOptions;
namespace hardened = protocol::hardened;

HandoffOptions options_of(Handoff handoff) {
  return handoff == Handoff::paper ? HandoffOptions{protocol::small_options()}
                                   : HandoffOptions{hardened::impatient()};
}

class ServedSegmentTest : public testing::TestWithParam<Handoff> {
 protected:
  /// Named objects that nobody uses any more.
  void leave_over(Handoff handoff) const {
    if (handoff == Handoff::paper) {
      protocol::SlaveSharedMemoryWrapper slave{name(), protocol::small_options()};
      ASSERT_TRUE(slave.open());
    } else {
      hardened::Slave slave{name(), hardened::impatient()};
      ASSERT_TRUE(slave.open());
    }
    ASSERT_EQ(found(), handoff);
  }
  [[nodiscard]] std::optional<Handoff> found() const { return protocol::handoff_of_segment(name()); }
  [[nodiscard]] const std::string& name() const { return segment_.name(); }
  [[nodiscard]] static Handoff other() {
    return GetParam() == Handoff::paper ? Handoff::hardened : Handoff::paper;
  }

  hardened::HardenedSegment segment_;
  protocol::RoleLock kernel_{name(), protocol::Role::kernel};
};

TEST_P(ServedSegmentTest, is_made_served_and_removed) {
  {
    ServedSegment served{name(), options_of(GetParam())};
    EXPECT_EQ(served.open(), "");
    EXPECT_EQ(found(), GetParam());
    auto port = std::visit([&](const auto& options) { return protocol::SharedMemoryPort{name(), options}; },
                           options_of(GetParam()));
    ASSERT_TRUE(port.open());
    ASSERT_TRUE(port.write(protocol::bytes("ask")));
    ASSERT_TRUE(served.slave().wait_for_request());
    EXPECT_EQ(protocol::text(served.slave().read_request()), "ask");
    served.slave().write_response(protocol::bytes("answer"));
    std::array<std::byte, 8> buffer{};
    EXPECT_EQ(port.read(buffer), 6U);
    EXPECT_EQ(served.at_the_end(), "");
  }
  EXPECT_EQ(found(), std::nullopt);
}

TEST_P(ServedSegmentTest, that_killed_processes_have_left_is_removed_whichever_handoff_it_has) {
  for (const Handoff left : {Handoff::paper, Handoff::hardened}) {
    leave_over(left);
    ServedSegment served{name(), options_of(GetParam())};
    EXPECT_EQ(served.open(), "removed what a killed process left of segment '" + name() + "'");
    EXPECT_EQ(found(), GetParam());
  }
  EXPECT_EQ(found(), std::nullopt);
}

TEST_P(ServedSegmentTest, with_a_kernel_attached_is_joined) {
  leave_over(GetParam());
  ASSERT_TRUE(kernel_.try_lock());
  ServedSegment served{name(), options_of(GetParam())};
  const auto told = served.open();
  ASSERT_TRUE(told) << told.error();
  EXPECT_EQ(*told, "segment '" + name() + "' is there and a kernel is attached: joined" +
                       (GetParam() == Handoff::paper ? " as it is" : ""));
  EXPECT_EQ(served.at_the_end(),
            GetParam() == Handoff::paper
                ? "a kernel is still attached; it has to be started again to find the next "
                  "emulator"
                : "a kernel is still attached; the segment stays until it ends");
}

TEST_P(ServedSegmentTest, of_the_other_handoff_with_a_kernel_attached_is_refused_and_left_alone) {
  leave_over(other());
  const auto memory = hardened::NamedMemory::identity_of(name());
  ASSERT_TRUE(memory);
  ASSERT_TRUE(kernel_.try_lock());
  {
    ServedSegment served{name(), options_of(GetParam())};
    const std::string option = "--protocol " + std::string{protocol::name_of(other())};
    EXPECT_EQ(served.open(), tl::make_unexpected("segment '" + name() + "': a kernel with " + option +
                                                 " is attached to it. Stop that kernel, give " + option +
                                                 ", or choose another name"));
  }
  EXPECT_EQ(found(), other());
  EXPECT_EQ(hardened::NamedMemory::identity_of(name()), memory);
  protocol::RoleLock emulator{name(), protocol::Role::emulator};
  EXPECT_TRUE(emulator.try_lock()) << "nobody serves it";
}

TEST_P(ServedSegmentTest, has_one_emulator_whichever_handoff_the_second_one_has) {
  ServedSegment first{name(), options_of(GetParam())};
  ASSERT_TRUE(first.open());
  for (const Handoff second_one : {Handoff::paper, Handoff::hardened}) {
    ServedSegment second{name(), options_of(second_one)};
    const auto refused = second.open();
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().find("another emulator serves it"), std::string::npos) << refused.error();
  }
  EXPECT_EQ(found(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Handoff, ServedSegmentTest, testing::Values(Handoff::hardened, Handoff::paper),
                         [](const auto& handoff) { return std::string{protocol::name_of(handoff.param)}; });

class HardenedServedSegment : public ServedSegmentTest {};

TEST_F(HardenedServedSegment, stays_with_a_kernel_that_outlives_the_emulator) {
  hardened::Master kernel{name(), hardened::impatient()};
  {
    ServedSegment served{name(), options_of(Handoff::hardened)};
    ASSERT_TRUE(served.open());
    ASSERT_TRUE(kernel.open());
  }
  EXPECT_EQ(found(), Handoff::hardened);
  {
    ServedSegment next{name(), options_of(Handoff::hardened)};
    ASSERT_TRUE(next.open());
    EXPECT_TRUE(kernel.write(protocol::bytes("ask"))) << "the next emulator is found without opening again";
    EXPECT_TRUE(next.slave().wait_for_request());
  }
  kernel.close();
  protocol::remove_if_unused(name(), options_of(Handoff::hardened));
  EXPECT_EQ(found(), std::nullopt);
}

}  // namespace
}  // namespace emulator_models
