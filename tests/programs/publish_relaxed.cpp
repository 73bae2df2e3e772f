// A producer writes a message and raises a flag; a consumer that sees the flag reads the message.
// Bug: the flag is relaxed, so it orders nothing: a data race, the message may still be the old one.
// Correction: release for the store, acquire for the load.

#include <atomic>
#include <cstdio>
#include <thread>

#ifdef CORRECTED
constexpr std::memory_order publish = std::memory_order_release;
constexpr std::memory_order observe = std::memory_order_acquire;
#else
constexpr std::memory_order publish = std::memory_order_relaxed;
constexpr std::memory_order observe = std::memory_order_relaxed;
#endif

int main() {
  int message = 0;
  bool wrong = false;
  std::atomic<bool> ready{false};
  std::thread consumer([&] {
    if (ready.load(observe)) wrong = message != 42;
  });
  std::thread producer([&] {
    message = 42;
    ready.store(true, publish);
  });
  consumer.join();
  producer.join();
  if (wrong) {
    std::fprintf(stderr, "an old message was read\n");
    return 1;
  }
  return 0;
}
