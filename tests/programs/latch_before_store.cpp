// Workers compute a part each and count a latch down; main waits for the latch and adds the parts up.
// Bug: a worker counts down before it has stored its part.
// Correction: store, then count down. Argument: number of workers.

#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <latch>
#include <thread>
#include <vector>

int main(int argc, char** argv) {
  const int workers = argc > 1 ? std::atoi(argv[1]) : 2;
  std::vector<std::atomic<int>> parts(static_cast<std::size_t>(workers));
  std::latch ready(workers);
  std::vector<std::jthread> threads;
  for (std::atomic<int>& part : parts) {
    threads.emplace_back([&part, &ready] {
#ifdef CORRECTED
      part.store(5);
      ready.count_down();
#else
      ready.count_down();
      part.store(5);
#endif
    });
  }
  ready.wait();
  int sum = 0;
  for (const std::atomic<int>& part : parts) sum += part.load();
  if (sum != 5 * workers) {
    std::fprintf(stderr, "sum %d\n", sum);
    return 1;
  }
  return 0;
}
