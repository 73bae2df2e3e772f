// Setters store a measurement under one lock and the scaled copy under a second; a checker compares.
// Bug: between the two locks the checker sees the new measurement with the old scaled value.
// Correction: both locks are held over both stages. Argument: number of setters.

#undef NDEBUG
#include <cassert>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

static std::mutex raw_mutex;
static int raw = 0;
static std::mutex scaled_mutex;
static int scaled = 0;

static void measure() {
#ifdef CORRECTED
  const std::scoped_lock both(raw_mutex, scaled_mutex);
  raw = 7;
  scaled = raw * 10;
#else
  int copy = 0;
  {
    const std::lock_guard<std::mutex> guard(raw_mutex);
    raw = 7;
    copy = raw;
  }
  {
    const std::lock_guard<std::mutex> guard(scaled_mutex);
    scaled = copy * 10;
  }
#endif
}

static void check() {
#ifdef CORRECTED
  const std::scoped_lock both(raw_mutex, scaled_mutex);
  assert(scaled == raw * 10);
#else
  int seen = 0;
  {
    const std::lock_guard<std::mutex> guard(raw_mutex);
    seen = raw;
  }
  const std::lock_guard<std::mutex> guard(scaled_mutex);
  assert(seen == 0 || scaled == seen * 10);
#endif
}

int main(int argc, char** argv) {
  const int setters = argc > 1 ? std::atoi(argv[1]) : 3;
  std::vector<std::thread> threads;
  for (int i = 0; i < setters; ++i) threads.emplace_back(measure);
  threads.emplace_back(check);
  for (std::thread& thread : threads) thread.join();
  return 0;
}
