// Two withdrawals from one account that covers only one of them.
// Bug: the balance is checked under the lock, but the lock is let go before the withdrawal: overdrawn.
// Correction: check and withdraw under one lock.

#include <cstdio>
#include <mutex>
#include <thread>

class Account {
 public:
  explicit Account(int balance) : balance_(balance) {}

  [[nodiscard]] int balance() {
    const std::lock_guard<std::mutex> guard(mutex_);
    return balance_;
  }

  bool withdraw(int amount) {
#ifdef CORRECTED
    const std::lock_guard<std::mutex> guard(mutex_);
    if (balance_ < amount) return false;
#else
    if (balance() < amount) return false;
    const std::lock_guard<std::mutex> guard(mutex_);
#endif
    balance_ -= amount;
    return true;
  }

 private:
  std::mutex mutex_;
  int balance_;
};

int main() {
  Account account(100);
  std::thread shop([&account] { account.withdraw(80); });
  std::thread rent([&account] { account.withdraw(70); });
  shop.join();
  rent.join();
  if (account.balance() < 0) {
    std::fprintf(stderr, "overdrawn: %d\n", account.balance());
    return 1;
  }
  return 0;
}
