// Two threads share a picture with an atomic reference count; the last one to drop it deletes it.
// Bug: the count is lowered and then read again: both can see zero (use after free, double free).
// Correction: decide by the value that the decrement returned.

#include <atomic>
#include <thread>

class Picture {
 public:
  void drop() {
#ifdef CORRECTED
    if (references_.fetch_sub(1) == 1) delete this;
#else
    references_.fetch_sub(1);
    if (references_.load() == 0) delete this;
#endif
  }

 private:
  ~Picture() = default;
  std::atomic<int> references_{2};
};

int main() {
  auto* const picture = new Picture;
  std::thread one([picture] { picture->drop(); });
  std::thread two([picture] { picture->drop(); });
  one.join();
  two.join();
  return 0;
}
