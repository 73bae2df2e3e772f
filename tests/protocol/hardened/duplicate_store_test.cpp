// The answer to the last request, for whoever asks again.

#include <gtest/gtest.h>

#include "protocol/hardened/duplicate_store.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol::hardened {
namespace {

TEST(DuplicateStore, is_empty_at_first_also_for_the_request_zero_of_session_zero) {
  EXPECT_FALSE(DuplicateStore(8).find(0, 0));
}

TEST(DuplicateStore, has_the_answer_to_the_last_request_only) {
  DuplicateStore store(8);
  store.put(1, 10, bytes("ten"));
  store.put(1, 11, bytes("eleven"));
  ASSERT_TRUE(store.find(1, 11));
  EXPECT_EQ(text(*store.find(1, 11)), "eleven");
  EXPECT_FALSE(store.find(1, 10));
}

TEST(DuplicateStore, tells_sessions_apart) {
  DuplicateStore store(8);
  store.put(1, 10, bytes("ten"));
  EXPECT_FALSE(store.find(2, 10));
}

TEST(DuplicateStore, tells_sequences_apart_that_are_equal_in_their_low_16_bits) {
  DuplicateStore store(8);
  store.put(1, 0x1'0005, bytes("late"));
  EXPECT_FALSE(store.find(1, 5));
}

TEST(DuplicateStore, remembers_that_an_answer_was_empty) {
  DuplicateStore store(8);
  store.put(1, 10, {});
  ASSERT_TRUE(store.find(1, 10));
  EXPECT_TRUE(store.find(1, 10)->empty());
}

}  // namespace
}  // namespace protocol::hardened
