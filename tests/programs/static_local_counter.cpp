// Orders get their number from a counter in a static local variable.
// Bug: only its initialisation is protected, not the increment: a data race, a number is given out twice.
// Correction: the counter is atomic.

#undef NDEBUG
#include <atomic>
#include <cassert>
#include <thread>

static int next_number() {
#ifdef CORRECTED
  static std::atomic<int> last{100};
#else
  static int last = 100;
#endif
  return ++last;
}

int main() {
  int first = 0;
  int second = 0;
  std::thread one([&first] { first = next_number(); });
  std::thread two([&second] { second = next_number(); });
  one.join();
  two.join();
  assert(first != second);
  return 0;
}
