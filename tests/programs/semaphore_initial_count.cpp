// Three clients share two printers; a semaphore lets in as many as there are printers.
// Bug: the semaphore starts with one too many, so a client may find no free printer.
// Correction: it starts with the number of printers.

#undef NDEBUG
#include <semaphore.h>

#include <array>
#include <atomic>
#include <cassert>
#include <thread>
#include <vector>

constexpr int printers = 2;
constexpr int clients = 3;

#ifdef CORRECTED
constexpr unsigned tokens = printers;
#else
constexpr unsigned tokens = printers + 1;
#endif
static sem_t free_printers;
static std::array<std::atomic<bool>, printers> busy{};

static void print() {
  sem_wait(&free_printers);
  bool printed = false;
  for (std::atomic<bool>& printer : busy) {
    if (printer.exchange(true)) continue;
    printed = true;
    printer.store(false);
    break;
  }
  assert(printed);
  sem_post(&free_printers);
}

int main() {
  sem_init(&free_printers, 0, tokens);
  std::vector<std::jthread> threads;
  for (int i = 0; i < clients; ++i) threads.emplace_back(print);
  return 0;
}
