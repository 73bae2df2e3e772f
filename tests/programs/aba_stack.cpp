// A lock-free free-list of three buffers, linked by index; two threads borrow buffers and return them.
// Bug: the head may go A, B, A between the load and the exchange; then a borrowed buffer becomes the head.
// Correction: the upper half of the head counts the changes.

#undef NDEBUG
#include <array>
#include <atomic>
#include <cassert>
#include <cstdint>
#include <thread>

constexpr std::uint32_t none = 3;

class FreeList {
 public:
  FreeList() {
    for (std::uint32_t i = 0; i < none; ++i) next_[i].store(i + 1);
  }

  std::uint32_t borrow() {
    std::uint64_t head = head_.load();
    for (;;) {
      const std::uint32_t index = index_of(head);
      if (index == none) return none;
      if (head_.compare_exchange_weak(head, following(head, next_[index].load()))) {
        assert(!borrowed_[index].exchange(true) && "a buffer was given out twice");
        return index;
      }
    }
  }

  void give_back(std::uint32_t index) {
    borrowed_[index].store(false);
    std::uint64_t head = head_.load();
    do {
      next_[index].store(index_of(head));
    } while (!head_.compare_exchange_weak(head, following(head, index)));
  }

  /// Buffers that can be reached from the head; more than there are means a ring.
  [[nodiscard]] int free_count() const {
    int count = 0;
    for (std::uint32_t i = index_of(head_.load()); i != none && count <= 3; i = next_[i].load()) ++count;
    return count;
  }

 private:
  static std::uint32_t index_of(std::uint64_t head) { return static_cast<std::uint32_t>(head); }

  static std::uint64_t following([[maybe_unused]] std::uint64_t head, std::uint32_t index) {
#ifdef CORRECTED
    return (((head >> 32U) + 1) << 32U) | index;
#else
    return index;
#endif
  }

  std::atomic<std::uint64_t> head_{0};
  std::array<std::atomic<std::uint32_t>, none> next_{};
  std::array<std::atomic<bool>, none> borrowed_{};
};

int main() {
  FreeList list;
  std::thread one([&list] {
    const std::uint32_t buffer = list.borrow();
    if (buffer != none) list.give_back(buffer);
  });
  std::thread two([&list] {
    const std::uint32_t first = list.borrow();
    const std::uint32_t second = list.borrow();
    if (first != none) list.give_back(first);
    if (second != none) list.give_back(second);
  });
  one.join();
  two.join();
  assert(list.free_count() == 3);
  return 0;
}
