// A producer hands items to a consumer through a Boost.Lockfree queue; the consumer takes them until the producer is done.
// Bug: the producer says so before its last item; the consumer may be gone when that comes.
// Correction: it says so after it.
//
// One producer and one consumer: with more of either, Boost 1.74's queue has data races of its own, as its stack has (stack_two_poppers).

#include <atomic>
#include <cstdio>
#include <thread>

#include <boost/lockfree/queue.hpp>

int main() {
  boost::lockfree::queue<int> queue{2};
  std::atomic<bool> done{false};
  int sum = 0;
  std::thread consumer([&] {
    int item = 0;
    const auto take_all = [&] {
      while (queue.pop(item)) sum += item;
    };
    while (!done) {
      take_all();
      std::this_thread::yield();
    }
    take_all();
  });
  queue.push(1);
  queue.push(2);
#ifdef CORRECTED
  queue.push(3);
  done = true;
#else
  done = true;
  queue.push(3);
#endif
  consumer.join();
  if (sum != 1 + 2 + 3) {
    std::fprintf(stderr, "the items taken add up to %d\n", sum);
    return 1;
  }
  return 0;
}
