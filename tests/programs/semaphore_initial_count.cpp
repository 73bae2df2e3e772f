// Three clients share two printers; a semaphore lets in as many as there are printers.
// Bug: the semaphore starts with one too many, so a client may find no free printer.
// Correction: it starts with the number of printers.

#undef NDEBUG
#include <array>
#include <atomic>
#include <cassert>
#include <semaphore>
#include <thread>
#include <vector>

constexpr int printers = 2;
constexpr int clients = 3;

#ifdef CORRECTED
static std::counting_semaphore<clients> free_printers(printers);
#else
static std::counting_semaphore<clients> free_printers(printers + 1);
#endif
static std::array<std::atomic<bool>, printers> busy{};

static void print() {
  free_printers.acquire();
  bool printed = false;
  for (std::atomic<bool>& printer : busy) {
    if (printer.exchange(true)) continue;
    printed = true;
    printer.store(false);
    break;
  }
  assert(printed);
  free_printers.release();
}

int main() {
  std::vector<std::jthread> threads;
  for (int i = 0; i < clients; ++i) threads.emplace_back(print);
  return 0;
}
