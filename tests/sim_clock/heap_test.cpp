// Blocks are listed while somebody asks for it, and malloc and its kind do what they do without that.
#include "sim_clock/world/heap.hpp"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include <gtest/gtest.h>

namespace ltsim {
namespace {

std::uintptr_t number_of(const void* address) { return reinterpret_cast<std::uintptr_t>(address); }

/// Not what the compiler may take away together with its free().
template <typename Pointer>
Pointer used(Pointer pointer) {
  asm volatile("" : "+r"(pointer) : : "memory");
  return pointer;
}

class HeapTest : public testing::Test {
 protected:
  HeapTest() {
    // What will be handed out again is full of something.
    std::array<void*, 16> blocks{};
    for (void*& block : blocks) block = std::memset(used(std::malloc(24)), 0xff, 24);
    for (void* const block : blocks) std::free(block);
    Heap::begin(nobody_);
  }
  ~HeapTest() override { Heap::end(); }

  static const Heap::Block* block_of(const void* address) { return Heap::find(number_of(address)); }
  Task* const& nobody() { return nobody_; }

 private:
  Task* nobody_ = nullptr;
};

TEST_F(HeapTest, lists_a_block_by_each_way_to_get_one_filled_with_zeros) {
  void* aligned = nullptr;
  ASSERT_EQ(posix_memalign(&aligned, 64, 24), 0);
  for (void* const block : {used(std::malloc(24)), used(std::calloc(3, 8)), used(std::realloc(nullptr, 24)),
                            used(std::aligned_alloc(64, 24)), used(::memalign(64, 24)), used(aligned),
                            used(static_cast<void*>(::operator new(24)))}) {
    const Heap::Block* const listed = block_of(block);
    ASSERT_NE(listed, nullptr);
    EXPECT_EQ(listed->begin, number_of(block));
    EXPECT_EQ(listed->bytes, 24U);
    EXPECT_FALSE(listed->is_freed);
    const auto* const bytes = static_cast<const unsigned char*>(block);
    EXPECT_TRUE(std::all_of(bytes, bytes + 24, [](unsigned char byte) { return byte == 0; }));
    const std::uintptr_t address = used(number_of(block));
    std::free(block);
    ASSERT_NE(Heap::find(address), nullptr);
    EXPECT_TRUE(Heap::find(address)->is_freed);
  }
}

TEST_F(HeapTest, an_address_is_of_the_block_that_it_lies_in_or_ends) {
  char* const block = used(static_cast<char*>(std::malloc(100)));
  EXPECT_EQ(block_of(block + 50), block_of(block));
  EXPECT_EQ(block_of(block + 100), block_of(block));
  EXPECT_NE(block_of(block + 101), block_of(block));
  EXPECT_NE(block_of(block - 1), block_of(block));
  std::free(block);
}

TEST_F(HeapTest, a_block_that_is_made_longer_keeps_its_bytes_and_one_that_is_made_shorter_its_first_ones) {
  char* block = used(static_cast<char*>(std::malloc(8)));
  std::memcpy(block, "1234567", 8);
  block = used(static_cast<char*>(std::realloc(block, 4000)));
  EXPECT_STREQ(block, "1234567");
  EXPECT_EQ(block[3999], 0);
  EXPECT_EQ(block_of(block)->bytes, 4000U);
  block = used(static_cast<char*>(std::realloc(block, 4)));
  EXPECT_EQ(std::memcmp(block, "1234", 4), 0);
  EXPECT_EQ(block_of(block)->bytes, 4U);
  std::free(block);
}

TEST_F(HeapTest, what_others_get_is_not_listed_and_takes_the_place_of_what_was_freed_there) {
  void* const block = used(std::malloc(48));
  const std::uintptr_t address = used(number_of(block));
  std::free(block);
  const Heap::Pause pause;
  Heap::allocated_by_others(reinterpret_cast<void*>(address), 48);
  EXPECT_EQ(Heap::find(address), nullptr);
  void* const other = used(std::malloc(48));
  const Heap::Block* const listed = block_of(other);
  EXPECT_TRUE(listed == nullptr || listed->begin + listed->bytes == number_of(other));
  std::free(other);
}

TEST_F(HeapTest, names_depend_on_the_order_and_not_on_the_place) {
  const auto name_of_second = [] {
    void* const one = used(std::malloc(10));
    void* const two = used(std::malloc(20));
    const std::uint64_t name = block_of(two)->name;
    std::free(one);
    std::free(two);
    return name;
  };
  const std::uint64_t name = name_of_second();
  Heap::end();
  void* const in_the_way = used(std::malloc(20));
  Heap::begin(nobody());
  EXPECT_EQ(name_of_second(), name);
  std::free(in_the_way);
}

TEST_F(HeapTest, refuses_an_alignment_that_is_none) {
  void* block = nullptr;
  EXPECT_EQ(posix_memalign(&block, 3, 8), EINVAL);
  EXPECT_EQ(posix_memalign(&block, 24, 8), EINVAL);
  EXPECT_EQ(posix_memalign(&block, 0, 8), EINVAL);
  EXPECT_EQ(block, nullptr);
}

TEST(HeapAtRest, lists_nothing) {
  EXPECT_FALSE(Heap::is_listing());
  void* const block = used(std::malloc(8));
  EXPECT_FALSE(Heap::is_listing());
  std::free(block);
}

}  // namespace
}  // namespace ltsim
