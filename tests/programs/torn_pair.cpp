// Writers store their own number into both halves of a record; in the end the halves must be equal.
// Bug: nothing holds the two stores together (a data race, and the halves may differ).
// Correction: one mutex around both stores. Argument: number of writers.

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

struct Record {
  int front = 0;
  int back = 0;
  std::mutex mutex;
};

static void write(Record& record, int value) {
#ifdef CORRECTED
  const std::lock_guard<std::mutex> guard(record.mutex);
#endif
  record.front = value;
  record.back = value;
}

int main(int argc, char** argv) {
  const int writers = argc > 1 ? std::atoi(argv[1]) : 3;
  Record record;
  std::vector<std::thread> threads;
  for (int i = 1; i <= writers; ++i) threads.emplace_back([&record, i] { write(record, i); });
  for (std::thread& thread : threads) thread.join();
  if (record.front != record.back) {
    std::fprintf(stderr, "torn record: %d and %d\n", record.front, record.back);
    return 1;
  }
  return 0;
}
