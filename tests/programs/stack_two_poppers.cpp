// Two workers pop jobs from a Boost.Lockfree stack onto which main pushes them.
// Bug, of Boost 1.74: pop() reads where the next node is, an ordinary variable, from a node that another pop() may already have put on
// the list of free ones, where it writes it. The exchange that follows fails, so x86 hides it; C++ calls it a data race
// (https://github.com/boostorg/lockfree/issues/22).
// Correction: the workers take turns by a mutex.

#include <atomic>
#include <cstdio>
#include <mutex>
#include <thread>

#include <boost/lockfree/stack.hpp>

int main() {
  boost::lockfree::stack<int> stack{3};
  std::mutex poppers;
  std::atomic<int> sum{0};
  const auto pop_one = [&] {
#ifdef CORRECTED
    const std::lock_guard lock{poppers};
#endif
    int job = 0;
    if (stack.pop(job)) sum += job;
  };
  const auto work = [&] {
    pop_one();
    pop_one();
  };
  stack.push(1);
  stack.push(2);
  std::thread first(work);
  std::thread second(work);
  stack.push(3);
  first.join();
  second.join();
  pop_one();
  if (sum != 1 + 2 + 3) {
    std::fprintf(stderr, "the jobs done add up to %d\n", sum.load());
    return 1;
  }
  return 0;
}
