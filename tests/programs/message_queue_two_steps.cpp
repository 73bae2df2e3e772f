// Two workers take orders from a Boost.Interprocess message queue until it is empty, and send what they add up to through another one,
// which has room for one message.
// Bug: "is there a message?" and receive() are two steps; a worker may wait for a message that the other one has taken.
// Correction: try_receive() is both in one.

#include <cstdio>
#include <string>
#include <thread>

#include <unistd.h>
#include <boost/interprocess/ipc/message_queue.hpp>

using boost::interprocess::message_queue;

namespace {

/// A queue of numbers with a name of its own, which is gone at the end.
class Numbers {
 public:
  Numbers(const std::string& purpose, std::size_t room)
      : name_(purpose + "-" + std::to_string(getpid())),
        queue_(boost::interprocess::open_or_create, name_.c_str(), room, sizeof(int)) {}
  ~Numbers() { message_queue::remove(name_.c_str()); }
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  void send(int number) { queue_.send(&number, sizeof number, 0); }
  int receive() {
    int number = 0;
    message_queue::size_type bytes = 0;
    unsigned priority = 0;
    queue_.receive(&number, sizeof number, bytes, priority);
    return number;
  }
  bool try_receive(int& number) {
    message_queue::size_type bytes = 0;
    unsigned priority = 0;
    return queue_.try_receive(&number, sizeof number, bytes, priority);
  }
  [[nodiscard]] bool empty() { return queue_.get_num_msg() == 0; }

 private:
  std::string name_;
  message_queue queue_;
};

}  // namespace

int main() {
  constexpr int orders_count = 3;
  Numbers orders{"orders", orders_count};
  Numbers sums{"sums", 1};
  for (int order = 1; order <= orders_count; ++order) orders.send(order);
  const auto work = [&] {
    int sum = 0;
#ifdef CORRECTED
    for (int order = 0; orders.try_receive(order);) sum += order;
#else
    while (!orders.empty()) sum += orders.receive();
#endif
    sums.send(sum);
  };
  std::thread first(work);
  std::thread second(work);
  const int one = sums.receive();
  const int sum = one + sums.receive();
  first.join();
  second.join();
  if (sum != 1 + 2 + 3) {
    std::fprintf(stderr, "the orders add up to %d\n", sum);
    return 1;
  }
  return 0;
}
