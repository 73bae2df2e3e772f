// A consumer takes two items; when there is none it sleeps until the producer changes the epoch.
// Bug: it reads the epoch after it has looked for an item; an item that comes in between is missed.
// Correction: read the epoch first, then look.

#include <atomic>
#include <cstdio>
#include <thread>

static std::atomic<int> items{0};
static std::atomic<int> epoch{0};

static bool try_take() {
  int count = items.load();
  while (count > 0) {
    if (items.compare_exchange_weak(count, count - 1)) return true;
  }
  return false;
}

static void take() {
  for (;;) {
#ifdef CORRECTED
    const int seen = epoch.load();
    if (try_take()) return;
#else
    if (try_take()) return;
    const int seen = epoch.load();
#endif
    epoch.wait(seen);
  }
}

static void put() {
  items.fetch_add(1);
  epoch.fetch_add(1);
  epoch.notify_one();
}

int main() {
  std::thread producer([] {
    put();
    put();
  });
  take();
  take();
  producer.join();
  if (items.load() != 0) {
    std::fprintf(stderr, "%d items left\n", items.load());
    return 1;
  }
  return 0;
}
