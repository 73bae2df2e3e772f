// Philosophers around a table each need the fork on either side to eat once.
// Bug: all take the left fork first; if each has one, nobody gets a second.
// Correction: the last one takes the right fork first. Argument: number of philosophers.

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 3;
  if (count < 2) return 2;
  std::vector<std::mutex> forks(count);
  std::vector<int> meals(count, 0);
  std::vector<std::thread> philosophers;
  for (std::size_t seat = 0; seat < count; ++seat) {
    philosophers.emplace_back([&forks, &meals, seat, count] {
      std::mutex* first = &forks[seat];
      std::mutex* second = &forks[(seat + 1) % count];
#ifdef CORRECTED
      if (seat + 1 == count) std::swap(first, second);
#endif
      const std::lock_guard<std::mutex> one(*first);
      const std::lock_guard<std::mutex> other(*second);
      ++meals[seat];
    });
  }
  for (std::thread& philosopher : philosophers) philosopher.join();
  for (const int eaten : meals) {
    if (eaten != 1) {
      std::fprintf(stderr, "a philosopher ate %d times\n", eaten);
      return 1;
    }
  }
  return 0;
}
