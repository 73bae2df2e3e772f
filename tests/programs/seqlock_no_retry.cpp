// A position is published under a sequence number: odd while it is written. Readers take no lock.
// Bug: the reader looks at the sequence before it reads the position, but not again afterwards.
// Correction: a position is only good if the sequence is still the same.

#include <atomic>
#include <cstdio>
#include <optional>
#include <thread>

struct Position {
  int x;
  int y;
};

class Published {
 public:
  void write(Position position) {
    sequence_.fetch_add(1);
    x_.store(position.x);
    y_.store(position.y);
    sequence_.fetch_add(1);
  }

  [[nodiscard]] std::optional<Position> try_read() const {
    const unsigned before = sequence_.load();
    if (before % 2 != 0) return std::nullopt;
    const Position position{x_.load(), y_.load()};
#ifdef CORRECTED
    if (sequence_.load() != before) return std::nullopt;
#endif
    return position;
  }

 private:
  std::atomic<unsigned> sequence_{0};
  std::atomic<int> x_{0};
  std::atomic<int> y_{0};
};

int main() {
  Published published;
  bool wrong = false;
  std::thread writer([&published] {
    published.write({1, 1});
    published.write({2, 2});
  });
  std::thread reader([&] {
    for (int attempt = 0; attempt < 2; ++attempt) {
      const std::optional<Position> seen = published.try_read();
      if (seen && seen->x != seen->y) wrong = true;
    }
  });
  writer.join();
  reader.join();
  if (wrong) {
    std::fprintf(stderr, "a position of two halves was read\n");
    return 1;
  }
  return 0;
}
