// A coordinator and a worker meet at a home-made barrier at the start of each of two rounds.
// Bug: the barrier waits for its counter to be zero again; a fast thread that comes back for the next
// round raises it before the slow one has looked: both wait for ever. Correction: wait for the round.

#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <semaphore>
#include <thread>

class Barrier {
 public:
  explicit Barrier(int parties) : parties_(parties) {}

  void arrive_and_wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    if (++arrived_ == parties_) {
      arrived_ = 0;
      ++round_;
      released_.notify_all();
      return;
    }
#ifdef CORRECTED
    const int round = round_;
    released_.wait(lock, [this, round] { return round_ != round; });
#else
    released_.wait(lock, [this] { return arrived_ == 0; });
#endif
  }

 private:
  std::mutex mutex_;
  std::condition_variable released_;
  const int parties_;
  int arrived_ = 0;
  int round_ = 0;
};

int main() {
  Barrier round_starts(2);
  std::counting_semaphore<2> orders(0);
  int order = 0;
  int carried_out = 0;

  std::thread worker([&] {
    for (int round = 0; round < 2; ++round) {
      round_starts.arrive_and_wait();
      orders.acquire();
      carried_out += order;
    }
  });

  order = 1;
  for (int round = 0; round < 2; ++round) {
    round_starts.arrive_and_wait();
    orders.release();
  }
  worker.join();
  if (carried_out != 2) {
    std::fprintf(stderr, "%d orders carried out\n", carried_out);
    return 1;
  }
  return 0;
}
