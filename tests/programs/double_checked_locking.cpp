// A table of settings is made at first use; the pointer is looked at once without and once with the lock.
// Bug: the pointer is not atomic, so the look without the lock is a data race; the table may be half built.
// Correction: an atomic pointer, stored with release and loaded with acquire.

#include <atomic>
#include <cstdio>
#include <mutex>
#include <thread>

struct Settings {
  int width = 80;
  int height = 25;
};

static std::mutex making;
#ifdef CORRECTED
static std::atomic<Settings*> settings{nullptr};
#else
static Settings* settings = nullptr;
#endif

static const Settings& get_settings() {
#ifdef CORRECTED
  Settings* made = settings.load(std::memory_order_acquire);
  if (made == nullptr) {
    const std::lock_guard<std::mutex> guard(making);
    made = settings.load(std::memory_order_relaxed);  // ordered by the lock
    if (made == nullptr) {
      made = new Settings;
      settings.store(made, std::memory_order_release);
    }
  }
  return *made;
#else
  if (settings == nullptr) {
    const std::lock_guard<std::mutex> guard(making);
    if (settings == nullptr) settings = new Settings;
  }
  return *settings;
#endif
}

int main() {
  int area[2] = {0, 0};
  const auto measure = [&area](int slot) { area[slot] = get_settings().width * get_settings().height; };
  std::thread one(measure, 0);
  std::thread two(measure, 1);
  one.join();
  two.join();
  delete &get_settings();
  if (area[0] != 2000 || area[1] != 2000) {
    std::fprintf(stderr, "areas %d and %d\n", area[0], area[1]);
    return 1;
  }
  return 0;
}
