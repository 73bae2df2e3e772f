// Setters switch a valve on: demand 1, feedback -1. A checker may see both old or both new values.
// Bug: two atomic stores are not one; the checker can look between them.
// Correction: both values share one atomic word. Argument: number of setters.

#undef NDEBUG
#include <atomic>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

#ifdef CORRECTED
static std::atomic<std::uint32_t> valve{0};

static void set() { valve.store(0x0001'ffffU); }

static void check() {
  const std::uint32_t both = valve.load();
  const auto demand = static_cast<std::int16_t>(both >> 16U);
  const auto feedback = static_cast<std::int16_t>(both & 0xffffU);
  assert(demand + feedback == 0);
}
#else
static std::atomic<int> valve_demand{0};
static std::atomic<int> valve_feedback{0};

static void set() {
  valve_demand.store(1);
  valve_feedback.store(-1);
}

static void check() {
  const int demand = valve_demand.load();
  const int feedback = valve_feedback.load();
  assert(demand + feedback == 0);
}
#endif

int main(int argc, char** argv) {
  const int setters = argc > 1 ? std::atoi(argv[1]) : 3;
  std::vector<std::thread> threads;
  for (int i = 0; i < setters; ++i) threads.emplace_back(set);
  threads.emplace_back(check);
  for (std::thread& thread : threads) thread.join();
  return 0;
}
