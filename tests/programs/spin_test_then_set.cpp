// A spin lock of one atomic flag guards a counter.
// Bug: the flag is tested and set in two steps; two threads can hold the lock (then also a data race).
// Correction: one atomic exchange.

#include <atomic>
#include <cstdio>
#include <mutex>
#include <thread>

class SpinLock {
 public:
  void lock() {
#ifdef CORRECTED
    while (locked_.exchange(true)) std::this_thread::yield();
#else
    while (locked_.load()) std::this_thread::yield();
    locked_.store(true);
#endif
  }

  void unlock() { locked_.store(false); }

 private:
  std::atomic<bool> locked_{false};
};

int main() {
  SpinLock spin;
  int count = 0;
  const auto add = [&] {
    for (int i = 0; i < 2; ++i) {
      const std::lock_guard<SpinLock> guard(spin);
      ++count;
    }
  };
  std::thread one(add);
  std::thread two(add);
  one.join();
  two.join();
  if (count != 4) {
    std::fprintf(stderr, "count %d\n", count);
    return 1;
  }
  return 0;
}
