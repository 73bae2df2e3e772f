// Two consumers take one item each from a queue; a producer puts two.
// Bug: the condition is tested with `if`; a consumer that comes late takes the item of the one just woken.
// Correction: `while`.

#undef NDEBUG
#include <cassert>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

static std::mutex mutex;
static std::condition_variable filled;
static std::deque<int> queue;
static int sum = 0;

static void consume() {
  std::unique_lock<std::mutex> lock(mutex);
#ifdef CORRECTED
  while (queue.empty()) filled.wait(lock);
#else
  if (queue.empty()) filled.wait(lock);
#endif
  assert(!queue.empty());
  sum += queue.front();
  queue.pop_front();
}

static void produce(int item) {
  const std::lock_guard<std::mutex> guard(mutex);
  queue.push_back(item);
  filled.notify_one();
}

int main() {
  std::thread consumer_1(consume);
  std::thread consumer_2(consume);
  produce(3);
  produce(4);
  consumer_1.join();
  consumer_2.join();
  assert(sum == 7);
  return 0;
}
