// Two threads share a picture with a reference count inside; the last one to drop it deletes it.
// Bug: the count is a plain int: a data race; two drops can count as one (leak).
// Correction: std::atomic<int>.

#include <atomic>
#include <cstdio>
#include <thread>

class Picture {
 public:
  void drop() {
    if (--references_ == 0) delete this;
  }
  [[nodiscard]] int size() const { return size_; }

 private:
  ~Picture() = default;
#ifdef CORRECTED
  std::atomic<int> references_{2};
#else
  int references_ = 2;
#endif
  int size_ = 640;
};

int main() {
  auto* const picture = new Picture;
  std::atomic<int> total{0};
  const auto use = [picture, &total] {
    total += picture->size();
    picture->drop();
  };
  std::thread one(use);
  std::thread two(use);
  one.join();
  two.join();
  if (total.load() != 1280) {
    std::fprintf(stderr, "total %d\n", total.load());
    return 1;
  }
  return 0;
}
