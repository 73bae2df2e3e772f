// Two producers and two consumers share a buffer for one item and one condition variable.
// Bug: notify_one may wake a consumer where a producer is needed; it sleeps again, the token is gone.
// Correction: notify_all.

#undef NDEBUG
#include <cassert>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

class Buffer {
 public:
  void put(int item) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !item_.has_value(); });
    item_ = item;
    tell();
  }

  int take() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return item_.has_value(); });
    const int item = *item_;
    item_.reset();
    tell();
    return item;
  }

 private:
  void tell() {
#ifdef CORRECTED
    changed_.notify_all();
#else
    changed_.notify_one();
#endif
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<int> item_;
};

int main() {
  Buffer buffer;
  int first = 0;
  int second = 0;
  std::thread producer_1([&] { buffer.put(3); });
  std::thread consumer_1([&] { first = buffer.take(); });
  std::thread producer_2([&] { buffer.put(4); });
  std::thread consumer_2([&] { second = buffer.take(); });
  producer_1.join();
  consumer_1.join();
  producer_2.join();
  consumer_2.join();
  assert(first + second == 7);
  return 0;
}
