// A client waits for a worker to complete a request and then destroys the request.
// Bug: "done" is set before the lock is taken; the client may see it, leave, and destroy the mutex and
// the condition the worker is about to use. Correction: set and look at it under the lock only.

#undef NDEBUG
#include <atomic>
#include <cassert>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

struct Request {
  std::mutex mutex;
  std::condition_variable completed;
  std::atomic<bool> done{false};
  std::atomic<int> answer{0};
};

static void serve(Request* request) {
  request->answer.store(42);
#ifdef CORRECTED
  const std::lock_guard<std::mutex> guard(request->mutex);
  request->done.store(true);
#else
  request->done.store(true);
  const std::lock_guard<std::mutex> guard(request->mutex);
#endif
  request->completed.notify_one();
}

static int call(std::thread& worker) {
  const auto request = std::make_unique<Request>();
  worker = std::thread(serve, request.get());
#ifndef CORRECTED
  if (request->done.load()) return request->answer.load();
#endif
  std::unique_lock<std::mutex> lock(request->mutex);
  request->completed.wait(lock, [&request] { return request->done.load(); });
  const int answer = request->answer.load();
  lock.unlock();
  return answer;
}

int main() {
  std::thread worker;
  const int answer = call(worker);
  worker.join();
  assert(answer == 42);
  return 0;
}
