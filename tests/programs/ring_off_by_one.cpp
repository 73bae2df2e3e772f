// One producer, one consumer and a ring without locks; what the consumer does not get is drained at the end.
// Bug: the test for "empty" is off by one; the consumer may take a slot that is not written yet.
// Correction: equal positions mean empty.

#include <array>
#include <atomic>
#include <cstdio>
#include <optional>
#include <thread>

class Ring {
 public:
  bool put(int item) {
    const unsigned tail = tail_.load();
    if (tail - head_.load() == slots_.size()) return false;
    slots_[tail % slots_.size()].store(item);
    tail_.store(tail + 1);
    return true;
  }

  std::optional<int> take() {
    const unsigned head = head_.load();
#ifdef CORRECTED
    if (head >= tail_.load()) return std::nullopt;
#else
    if (head > tail_.load()) return std::nullopt;
#endif
    const int item = slots_[head % slots_.size()].load();
    head_.store(head + 1);
    return item;
  }

 private:
  std::array<std::atomic<int>, 4> slots_{};
  std::atomic<unsigned> head_{0};
  std::atomic<unsigned> tail_{0};
};

int main() {
  constexpr int items = 3;
  Ring ring;
  int taken = 0;
  int sum = 0;
  const auto take_one = [&] {
    const std::optional<int> item = ring.take();
    if (!item) return;
    ++taken;
    sum += *item;
  };
  std::thread producer([&ring] {
    for (int item = 1; item <= items; ++item) ring.put(item);
  });
  std::thread consumer([&] {
    for (int attempt = 0; attempt < items; ++attempt) take_one();
  });
  producer.join();
  consumer.join();
  for (int left = items - taken; left > 0; --left) take_one();
  if (sum != 1 + 2 + 3) {
    std::fprintf(stderr, "the items taken add up to %d\n", sum);
    return 1;
  }
  return 0;
}
