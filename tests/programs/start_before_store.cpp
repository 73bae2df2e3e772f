// A service runs a thread that finds its service through a global pointer.
// Bug: the thread is started before the pointer is stored; a quick thread follows a null pointer.
// Correction: store, then start.

#include <atomic>
#include <cstdio>
#include <memory>
#include <thread>

class Service {
 public:
  void start();
  void stop() { thread_.join(); }
  void tick() { ++ticks_; }
  [[nodiscard]] int ticks() const { return ticks_.load(); }

 private:
  std::atomic<int> ticks_{0};
  std::thread thread_;
};

static std::atomic<Service*> the_service{nullptr};

void Service::start() {
  thread_ = std::thread([] {
    Service* const service = the_service.load();
    service->tick();
  });
}

int main() {
  const auto service = std::make_unique<Service>();
#ifdef CORRECTED
  the_service.store(service.get());
  service->start();
#else
  service->start();
  the_service.store(service.get());
#endif
  service->stop();
  if (service->ticks() != 1) {
    std::fprintf(stderr, "%d ticks\n", service->ticks());
    return 1;
  }
  return 0;
}
