// Readers share a document, a writer needs it alone; the first reader takes the room, the last gives it back.
// Bug: a reader that finds the document empty leaves without counting itself out; the writer never gets in.
// Correction: it counts itself out like any other.

#include <semaphore.h>

#include <cstdio>
#include <mutex>
#include <thread>

class Document {
 public:
  Document() { sem_init(&room_, 0, 1); }
  ~Document() { sem_destroy(&room_); }
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  int read() {
    enter();
    const int text = text_;
#ifndef CORRECTED
    if (text == 0) return 0;
#endif
    leave();
    return text;
  }

  void write(int text) {
    sem_wait(&room_);
    text_ = text;
    sem_post(&room_);
  }

 private:
  void enter() {
    const std::lock_guard<std::mutex> guard(counting_);
    if (++readers_ == 1) sem_wait(&room_);
  }

  void leave() {
    const std::lock_guard<std::mutex> guard(counting_);
    if (--readers_ == 0) sem_post(&room_);
  }

  std::mutex counting_;
  int readers_ = 0;
  sem_t room_;
  int text_ = 0;
};

int main() {
  Document document;
  int seen[2] = {0, 0};
  std::thread writer(&Document::write, &document, 5);
  std::thread reader_1([&] { seen[0] = document.read(); });
  std::thread reader_2([&] { seen[1] = document.read(); });
  writer.join();
  reader_1.join();
  reader_2.join();
  if (document.read() != 5 || seen[0] + seen[1] > 10) {
    std::fprintf(stderr, "read %d and %d\n", seen[0], seen[1]);
    return 1;
  }
  return 0;
}
