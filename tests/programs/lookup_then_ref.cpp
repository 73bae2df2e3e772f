// A registry hands out its current session; a second thread removes the session meanwhile.
// Bug: the reference is counted after the lock of the registry was released: use after free.
// Correction: count the reference while the registry still holds its own.

#include <atomic>
#include <cstdio>
#include <mutex>
#include <thread>

class Session {
 public:
  void ref() { references_.fetch_add(1); }
  void unref() {
    if (references_.fetch_sub(1) == 1) delete this;
  }
  [[nodiscard]] int number() const { return number_.load(); }

 private:
  ~Session() = default;
  std::atomic<int> references_{1};
  std::atomic<int> number_{17};
};

static std::mutex registry_mutex;
static Session* current = nullptr;

static Session* find() {
  Session* found = nullptr;
  {
    const std::lock_guard<std::mutex> guard(registry_mutex);
    found = current;
#ifdef CORRECTED
    if (found != nullptr) found->ref();
#endif
  }
#ifndef CORRECTED
  if (found != nullptr) found->ref();
#endif
  return found;
}

static void remove_current() {
  Session* removed = nullptr;
  {
    const std::lock_guard<std::mutex> guard(registry_mutex);
    removed = current;
    current = nullptr;
  }
  if (removed != nullptr) removed->unref();
}

int main() {
  current = new Session;
  std::atomic<int> wrong{0};
  std::thread user([&wrong] {
    Session* const session = find();
    if (session == nullptr) return;
    if (session->number() != 17) ++wrong;
    session->unref();
  });
  std::thread administrator(remove_current);
  user.join();
  administrator.join();
  if (wrong.load() != 0) {
    std::fprintf(stderr, "read a session that was gone\n");
    return 1;
  }
  return 0;
}
