// A device is stopped while requests enter it: stop waits for those inside, then switches the power off.
// Bug: a request looks at the stop flag first and registers itself afterwards; stop fits in between.
// Correction: register first, then look at the flag and step back if it is set.

#undef NDEBUG
#include <atomic>
#include <cassert>
#include <thread>

class Device {
 public:
  void request() {
#ifdef CORRECTED
    ++inside_;
    if (stopping_.load()) {
      leave();
      return;
    }
#else
    if (stopping_.load()) return;
    ++inside_;
#endif
    assert(powered_.load());
    leave();
  }

  void stop() {
    stopping_.store(true);
    leave();
    drained_.wait(false);
    powered_.store(false);
  }

 private:
  void leave() {
    if (--inside_ == 0) {
      drained_.store(true);
      drained_.notify_all();
    }
  }

  std::atomic<int> inside_{1};  // the device itself counts as one until it is stopped
  std::atomic<bool> stopping_{false};
  std::atomic<bool> drained_{false};
  std::atomic<bool> powered_{true};
};

int main() {
  Device device;
  std::thread user([&device] { device.request(); });
  std::thread owner([&device] { device.stop(); });
  user.join();
  owner.join();
  return 0;
}
