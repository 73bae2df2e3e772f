// A pool with one worker; a job submits a second job; main waits until the pool is idle and stops it.
// Bug: "idle" looks at the queue alone, not at the job that runs; the job it submits next is lost.
// Correction: idle means an empty queue and no job running.

#include <condition_variable>
#include <cstdio>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

class Pool {
 public:
  Pool() : worker_(&Pool::run, this) {}

  void submit(std::function<void()> job) {
    const std::lock_guard<std::mutex> guard(mutex_);
    jobs_.push_back(std::move(job));
    changed_.notify_all();
  }

  void wait_until_idle() {
    std::unique_lock<std::mutex> lock(mutex_);
#ifdef CORRECTED
    changed_.wait(lock, [this] { return jobs_.empty() && !running_; });
#else
    changed_.wait(lock, [this] { return jobs_.empty(); });
#endif
  }

  void stop() {
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      stopping_ = true;
      changed_.notify_all();
    }
    worker_.join();
  }

 private:
  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
      if (stopping_) return;
      const std::function<void()> job = std::move(jobs_.front());
      jobs_.pop_front();
      running_ = true;
      changed_.notify_all();
      lock.unlock();
      job();
      lock.lock();
      running_ = false;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  bool running_ = false;
  bool stopping_ = false;
  std::thread worker_;  // last: starts when the rest is there
};

int main() {
  int done = 0;
  Pool pool;
  pool.submit([&] {
    ++done;
    pool.submit([&] { ++done; });
  });
  pool.wait_until_idle();
  pool.stop();
  if (done != 2) {
    std::fprintf(stderr, "%d of 2 jobs done\n", done);
    return 1;
  }
  return 0;
}
