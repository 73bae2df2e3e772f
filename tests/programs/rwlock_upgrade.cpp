// A name is given a number when it is first asked for; readers look it up under a shared lock.
// Bug: from the shared to the exclusive lock the table is not looked at again; a name gets two numbers.
// Correction: look again under the exclusive lock.

#include <cstdio>
#include <map>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <thread>

class Numbers {
 public:
  int number_of(const std::string& name) {
    {
      const std::shared_lock<std::shared_mutex> reading(mutex_);
      const auto found = numbers_.find(name);
      if (found != numbers_.end()) return found->second;
    }
    const std::unique_lock<std::shared_mutex> writing(mutex_);
#ifdef CORRECTED
    const auto found = numbers_.find(name);
    if (found != numbers_.end()) return found->second;
#endif
    const int number = next_++;
    numbers_[name] = number;
    return number;
  }

 private:
  std::shared_mutex mutex_;
  std::map<std::string, int> numbers_;
  int next_ = 1;
};

int main() {
  Numbers numbers;
  int one = 0;
  int two = 0;
  std::thread first([&] { one = numbers.number_of("pump"); });
  std::thread second([&] { two = numbers.number_of("pump"); });
  first.join();
  second.join();
  if (one != two) {
    std::fprintf(stderr, "one name, two numbers: %d and %d\n", one, two);
    return 1;
  }
  return 0;
}
