// Clerks count visitors under the lock of the hall; one clerk at the side door does the same.
// Bug: the side door takes the lock of the yard, so a visitor can be lost (also a data race).
// Correction: one counter, one lock. Argument: number of clerks in the hall.

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

static std::mutex hall;
static int visitors = 0;
#ifndef CORRECTED
static std::mutex yard;
#endif

static void count_visitor(std::mutex& mutex) {
  const std::lock_guard<std::mutex> guard(mutex);
  ++visitors;
}

int main(int argc, char** argv) {
  const int clerks = argc > 1 ? std::atoi(argv[1]) : 2;
  std::vector<std::thread> threads;
  for (int i = 0; i < clerks; ++i) threads.emplace_back([] { count_visitor(hall); });
#ifdef CORRECTED
  threads.emplace_back([] { count_visitor(hall); });
#else
  threads.emplace_back([] { count_visitor(yard); });
#endif
  for (std::thread& thread : threads) thread.join();
  if (visitors != clerks + 1) {
    std::fprintf(stderr, "%d visitors, expected %d\n", visitors, clerks + 1);
    return 1;
  }
  return 0;
}
