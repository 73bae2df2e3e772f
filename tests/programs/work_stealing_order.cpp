// A work-stealing deque (after Chase and Lev): the owner takes jobs at the bottom, a thief at the top.
// Bug: the owner reads the top before it has lowered the bottom, so both can get the same job.
// Correction: lower the bottom first, then read the top.

#include <array>
#include <atomic>
#include <cstdio>
#include <thread>

constexpr int no_job = -1;

class Deque {
 public:
  void push(int job) {
    const long bottom = bottom_.load();
    jobs_[static_cast<unsigned long>(bottom) % jobs_.size()].store(job);
    bottom_.store(bottom + 1);
  }

  int take() {
#ifdef CORRECTED
    const long bottom = bottom_.load() - 1;
    bottom_.store(bottom);
    long top = top_.load();
#else
    long top = top_.load();
    const long bottom = bottom_.load() - 1;
    bottom_.store(bottom);
#endif
    if (top > bottom) {
      bottom_.store(bottom + 1);
      return no_job;
    }
    const int job = jobs_[static_cast<unsigned long>(bottom) % jobs_.size()].load();
    if (top < bottom) return job;
    const bool won = top_.compare_exchange_strong(top, top + 1);
    bottom_.store(bottom + 1);
    return won ? job : no_job;
  }

  int steal() {
    long top = top_.load();
    if (top >= bottom_.load()) return no_job;
    const int job = jobs_[static_cast<unsigned long>(top) % jobs_.size()].load();
    return top_.compare_exchange_strong(top, top + 1) ? job : no_job;
  }

 private:
  std::atomic<long> top_{0};
  std::atomic<long> bottom_{0};
  std::array<std::atomic<int>, 4> jobs_{};
};

int main() {
  Deque deque;
  std::array<std::atomic<int>, 2> done{};
  const auto run = [&done](int job) {
    if (job != no_job) ++done[static_cast<unsigned>(job)];
  };
  deque.push(0);
  deque.push(1);
  std::thread thief([&] {
    run(deque.steal());
    run(deque.steal());
  });
  run(deque.take());
  run(deque.take());
  thief.join();
  run(deque.take());
  if (done[0].load() != 1 || done[1].load() != 1) {
    std::fprintf(stderr, "jobs were done %d and %d times\n", done[0].load(), done[1].load());
    return 1;
  }
  return 0;
}
