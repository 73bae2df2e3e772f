// Two threads move parts between two bins, one in each direction.
// Bug: each locks the bin it takes from first, so they can wait for each other.
// Correction: std::scoped_lock takes both without an order.

#include <cstdio>
#include <functional>
#include <mutex>
#include <thread>

struct Bin {
  std::mutex mutex;
  int parts = 5;
};

static void move_parts(Bin& from, Bin& to, int count) {
#ifdef CORRECTED
  const std::scoped_lock both(from.mutex, to.mutex);
#else
  const std::lock_guard<std::mutex> first(from.mutex);
  const std::lock_guard<std::mutex> second(to.mutex);
#endif
  from.parts -= count;
  to.parts += count;
}

int main() {
  Bin left;
  Bin right;
  std::thread there(move_parts, std::ref(left), std::ref(right), 2);
  std::thread back(move_parts, std::ref(right), std::ref(left), 3);
  there.join();
  back.join();
  if (left.parts != 6 || right.parts != 4) {
    std::fprintf(stderr, "parts: %d and %d\n", left.parts, right.parts);
    return 1;
  }
  return 0;
}
