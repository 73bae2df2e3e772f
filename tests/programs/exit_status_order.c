// One thread loads three records, another counts the missing ones; its count is the exit status.
// Bug: nothing makes the second thread wait for the first. Correction: wait until the records are loaded.

#include <threads.h>

enum { expected = 3 };

static mtx_t lock;
static cnd_t loaded_changed;
static int records = 0;
static int loaded = 0;

static int load(void *unused) {
  (void)unused;
  mtx_lock(&lock);
  records = expected;
  loaded = 1;
  cnd_signal(&loaded_changed);
  mtx_unlock(&lock);
  return 0;
}

static int count_missing(void *unused) {
  (void)unused;
  mtx_lock(&lock);
#ifdef CORRECTED
  while (!loaded) cnd_wait(&loaded_changed, &lock);
#endif
  const int missing = expected - records;
  mtx_unlock(&lock);
  return missing;
}

int main(void) {
  mtx_init(&lock, mtx_plain);
  cnd_init(&loaded_changed);
  thrd_t loader, counter;
  int missing = 0;
  if (thrd_create(&loader, load, NULL) != thrd_success) return 2;
  if (thrd_create(&counter, count_missing, NULL) != thrd_success) return 2;
  thrd_join(loader, NULL);
  thrd_join(counter, &missing);
  cnd_destroy(&loaded_changed);
  mtx_destroy(&lock);
  return missing;
}
