// Writers move a cursor; row and column must always come from the same writer.
// Bug: each coordinate has a lock of its own, so two writers can take turns between the coordinates.
// Correction: one lock for both. Argument: number of writers.

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

class Cursor {
 public:
  void move_to(int position) {
#ifdef CORRECTED
    const std::scoped_lock both(row_mutex_, column_mutex_);
    row_ = position;
    column_ = position;
#else
    {
      const std::lock_guard<std::mutex> guard(row_mutex_);
      row_ = position;
    }
    {
      const std::lock_guard<std::mutex> guard(column_mutex_);
      column_ = position;
    }
#endif
  }

  [[nodiscard]] bool on_diagonal() {
    const std::scoped_lock both(row_mutex_, column_mutex_);
    return row_ == column_;
  }

 private:
  std::mutex row_mutex_;
  std::mutex column_mutex_;
  int row_ = 0;
  int column_ = 0;
};

int main(int argc, char** argv) {
  const int writers = argc > 1 ? std::atoi(argv[1]) : 3;
  Cursor cursor;
  std::vector<std::thread> threads;
  for (int i = 1; i <= writers; ++i) threads.emplace_back(&Cursor::move_to, &cursor, i);
  for (std::thread& thread : threads) thread.join();
  if (!cursor.on_diagonal()) {
    std::fprintf(stderr, "row and column are from different writers\n");
    return 1;
  }
  return 0;
}
