// Two threads announce themselves and enter only if the other has not: at most one gets in.
// Bug: release and acquire let each announcement pass the look at the other one; both get in.
// Correction: sequentially consistent accesses. Weak memory only: no switch of threads alone shows it.

#undef NDEBUG
#include <atomic>
#include <cassert>
#include <thread>

#ifdef CORRECTED
constexpr std::memory_order announce = std::memory_order_seq_cst;
constexpr std::memory_order look = std::memory_order_seq_cst;
#else
constexpr std::memory_order announce = std::memory_order_release;
constexpr std::memory_order look = std::memory_order_acquire;
#endif

static std::atomic<bool> wants[2];
static std::atomic<int> entered{0};

static void try_to_enter(int self) {
  wants[self].store(true, announce);
  if (!wants[1 - self].load(look)) ++entered;
}

int main() {
  std::thread one(try_to_enter, 0);
  std::thread two(try_to_enter, 1);
  one.join();
  two.join();
  assert(entered.load() <= 1);
  return 0;
}
