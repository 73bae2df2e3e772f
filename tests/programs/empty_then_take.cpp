// Two workers empty a queue whose operations are all locked.
// Bug: "not empty" may no longer hold when the item is taken; the queue throws, nobody catches it.
// Correction: one operation that takes an item if there is one.

#include <atomic>
#include <cstdio>
#include <deque>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

class Queue {
 public:
  void put(int item) {
    const std::lock_guard<std::mutex> guard(mutex_);
    items_.push_back(item);
  }

  [[nodiscard]] bool empty() {
    const std::lock_guard<std::mutex> guard(mutex_);
    return items_.empty();
  }

  int take() {
    const std::optional<int> item = try_take();
    if (!item) throw std::out_of_range("take from an empty queue");
    return *item;
  }

  std::optional<int> try_take() {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (items_.empty()) return std::nullopt;
    const int item = items_.front();
    items_.pop_front();
    return item;
  }

 private:
  std::mutex mutex_;
  std::deque<int> items_;
};

int main() {
  Queue queue;
  std::atomic<int> sum{0};
  queue.put(1);
  queue.put(2);
  queue.put(3);
  const auto work = [&] {
#ifdef CORRECTED
    while (const std::optional<int> item = queue.try_take()) sum += *item;
#else
    while (!queue.empty()) sum += queue.take();
#endif
  };
  std::thread one(work);
  std::thread two(work);
  one.join();
  two.join();
  if (sum.load() != 6) {
    std::fprintf(stderr, "sum %d\n", sum.load());
    return 1;
  }
  return 0;
}
