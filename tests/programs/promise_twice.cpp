// Two servers answer one question; the first answer counts.
// Bug: "answered" is tested and set in two steps; the second set_value throws, nobody catches it.
// Correction: one atomic exchange.

#include <atomic>
#include <cstdio>
#include <functional>
#include <future>
#include <thread>

static std::atomic<bool> answered{false};

static void serve(std::promise<int>& answer, int value) {
#ifdef CORRECTED
  if (answered.exchange(true)) return;
#else
  if (answered.load()) return;
  answered.store(true);
#endif
  answer.set_value(value);
}

int main() {
  std::promise<int> answer;
  std::future<int> result = answer.get_future();
  std::thread near(serve, std::ref(answer), 1);
  std::thread far(serve, std::ref(answer), 2);
  const int value = result.get();
  near.join();
  far.join();
  if (value != 1 && value != 2) {
    std::fprintf(stderr, "answer %d\n", value);
    return 1;
  }
  return 0;
}
