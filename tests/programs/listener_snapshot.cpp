// A bell rings its listeners outside of its lock while a listener signs off and is destroyed.
// Bug: the snapshot of listeners holds plain pointers: use after free.
// Correction: the snapshot shares ownership.

#undef NDEBUG
#include <atomic>
#include <cassert>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

class Listener {
 public:
  void on_ring() { ++rings_; }
  [[nodiscard]] int rings() const { return rings_.load(); }

 private:
  std::atomic<int> rings_{0};
};

class Bell {
 public:
  void sign_on(std::shared_ptr<Listener> listener) {
    const std::lock_guard<std::mutex> guard(mutex_);
    listeners_.push_back(std::move(listener));
  }

  void sign_off_first() {
    const std::lock_guard<std::mutex> guard(mutex_);
    listeners_.erase(listeners_.begin());
  }

  void ring() {
#ifdef CORRECTED
    std::vector<std::shared_ptr<Listener>> snapshot;
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      snapshot = listeners_;
    }
    for (const std::shared_ptr<Listener>& listener : snapshot) listener->on_ring();
#else
    std::vector<Listener*> snapshot;
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      for (const std::shared_ptr<Listener>& listener : listeners_) snapshot.push_back(listener.get());
    }
    for (Listener* const listener : snapshot) listener->on_ring();
#endif
    const std::lock_guard<std::mutex> guard(mutex_);
    ++times_rung_;
  }

  [[nodiscard]] int times_rung() {
    const std::lock_guard<std::mutex> guard(mutex_);
    return times_rung_;
  }

 private:
  std::mutex mutex_;
  int times_rung_ = 0;
  std::vector<std::shared_ptr<Listener>> listeners_;
};

int main() {
  Bell bell;
  const auto stays = std::make_shared<Listener>();
  bell.sign_on(std::make_shared<Listener>());
  bell.sign_on(stays);
  std::thread visitor(&Bell::ring, &bell);
  std::thread leaver(&Bell::sign_off_first, &bell);
  visitor.join();
  leaver.join();
  assert(bell.times_rung() == 1 && stays->rings() == 1);
  return 0;
}
