// Two sensors put their readings into a Boost.Lockfree queue for one producer and one consumer; a logger takes them out. There is
// room for all.
// Bug: a queue for one producer has two; both may write the same slot.
// Correction: the sensors take turns by a mutex.

#include <cstdio>
#include <mutex>
#include <thread>

#include <boost/lockfree/spsc_queue.hpp>

namespace {

constexpr int readings = 2;  // of each sensor

boost::lockfree::spsc_queue<int, boost::lockfree::capacity<8>> queue;
std::mutex producers;

void measure(int first) {
  for (int i = 0; i < readings; ++i) {
#ifdef CORRECTED
    const std::lock_guard lock{producers};
#endif
    queue.push(first + i);
  }
}

}  // namespace

int main() {
  int sum = 0;
  int reading = 0;
  std::thread logger([&] {
    for (int attempt = 0; attempt < 2 * readings; ++attempt) {
      if (queue.pop(reading)) sum += reading;
    }
  });
  std::thread pressure(measure, 1);
  std::thread temperature(measure, 10);
  pressure.join();
  temperature.join();
  logger.join();
  while (queue.pop(reading)) sum += reading;
  if (sum != 1 + 2 + 10 + 11) {
    std::fprintf(stderr, "the readings add up to %d\n", sum);
    return 1;
  }
  return 0;
}
