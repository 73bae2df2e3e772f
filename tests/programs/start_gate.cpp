// Runners wait at a gate that main opens.
// Bug: the gate wakes one runner; if two or more are already waiting, the others stay there.
// Correction: notify_all. Argument: number of runners.

#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

class Gate {
 public:
  void pass() {
    std::unique_lock<std::mutex> lock(mutex_);
    opened_.wait(lock, [this] { return open_; });
    ++passed_;
  }

  void open() {
    const std::lock_guard<std::mutex> guard(mutex_);
    open_ = true;
#ifdef CORRECTED
    opened_.notify_all();
#else
    opened_.notify_one();
#endif
  }

  [[nodiscard]] int passed() const { return passed_; }

 private:
  std::mutex mutex_;
  std::condition_variable opened_;
  bool open_ = false;
  int passed_ = 0;
};

int main(int argc, char** argv) {
  const int runners = argc > 1 ? std::atoi(argv[1]) : 3;
  Gate gate;
  std::vector<std::thread> threads;
  for (int i = 0; i < runners; ++i) threads.emplace_back(&Gate::pass, &gate);
  gate.open();
  for (std::thread& thread : threads) thread.join();
  if (gate.passed() != runners) {
    std::fprintf(stderr, "%d of %d passed\n", gate.passed(), runners);
    return 1;
  }
  return 0;
}
