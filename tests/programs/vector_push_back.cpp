// Two threads append their results to one vector.
// Bug: nothing protects the vector: a data race; results get lost, storage is freed twice or leaks.
// Correction: a mutex around push_back.

#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

static std::mutex mutex;
static std::vector<int> results;

static void append(int result) {
#ifdef CORRECTED
  const std::lock_guard<std::mutex> guard(mutex);
#endif
  results.push_back(result);
}

int main() {
  std::thread one(append, 1);
  std::thread two(append, 2);
  one.join();
  two.join();
  const std::lock_guard<std::mutex> guard(mutex);
  if (results.size() != 2 || results[0] + results[1] != 3) {
    std::fprintf(stderr, "%zu results\n", results.size());
    return 1;
  }
  return 0;
}
