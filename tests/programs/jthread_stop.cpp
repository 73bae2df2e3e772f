// A worker thread sleeps until there is work or it is asked to stop.
// Bug: the request to stop is not made under the lock of the condition; if it comes between the worker's
// look and its sleep, the notification is lost. Correction: a wait that knows the stop token.

#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <stop_token>
#include <thread>

static std::mutex mutex;
#ifdef CORRECTED
static std::condition_variable_any changed;
#else
static std::condition_variable changed;
#endif
static int work = 0;
static int done = 0;

static void run(const std::stop_token& token) {
  std::unique_lock<std::mutex> lock(mutex);
  for (;;) {
#ifdef CORRECTED
    changed.wait(lock, token, [] { return work > 0; });
#else
    changed.wait(lock, [&token] { return work > 0 || token.stop_requested(); });
#endif
    if (work == 0) return;
    --work;
    ++done;
  }
}

int main() {
  std::jthread worker(run);
  {
    const std::lock_guard<std::mutex> guard(mutex);
    ++work;
    changed.notify_one();
  }
  worker.request_stop();
#ifndef CORRECTED
  changed.notify_one();
#endif
  worker.join();
  if (done != 1) {
    std::fprintf(stderr, "%d done\n", done);
    return 1;
  }
  return 0;
}
