// Two buyers take an item from a store that a supplier fills.
// Bug: lock and unlock are called by hand; when the store is empty an exception leaves it locked.
// Correction: std::lock_guard.

#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <thread>

static std::mutex mutex;
static int stock = 0;

static void take_item() {
  if (stock == 0) throw std::runtime_error("sold out");
  --stock;
}

static bool buy() {
  try {
#ifdef CORRECTED
    const std::lock_guard<std::mutex> guard(mutex);
    take_item();
#else
    mutex.lock();
    take_item();
    mutex.unlock();
#endif
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

int main() {
  int bought[2] = {0, 0};
  std::thread supplier([] {
    const std::lock_guard<std::mutex> guard(mutex);
    stock += 2;
  });
  std::thread first([&bought] { bought[0] = buy() ? 1 : 0; });
  std::thread second([&bought] { bought[1] = buy() ? 1 : 0; });
  supplier.join();
  first.join();
  second.join();
  if (bought[0] + bought[1] + stock != 2) {
    std::fprintf(stderr, "%d and %d bought, %d left\n", bought[0], bought[1], stock);
    return 1;
  }
  return 0;
}
