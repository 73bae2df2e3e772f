// A file has two flags, "open" and "dirty", each guarded by a lock of its own.
// Bug: both are bits of one word, so setting one also writes the other: a data race, one can be lost.
// Correction: each flag is a byte of its own.

#include <pthread.h>
#include <stdio.h>

#ifdef CORRECTED
struct flags {
  unsigned char open;
  unsigned char dirty;
};
#else
struct flags {
  unsigned char open : 1;
  unsigned char dirty : 1;
};
#endif

static struct flags flags;
static pthread_mutex_t open_lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_mutex_t dirty_lock = PTHREAD_MUTEX_INITIALIZER;

static void *set_open(void *unused) {
  (void)unused;
  pthread_mutex_lock(&open_lock);
  flags.open = 1;
  pthread_mutex_unlock(&open_lock);
  return NULL;
}

static void *set_dirty(void *unused) {
  (void)unused;
  pthread_mutex_lock(&dirty_lock);
  flags.dirty = 1;
  pthread_mutex_unlock(&dirty_lock);
  return NULL;
}

int main(void) {
  pthread_t one, two;
  pthread_create(&one, NULL, set_open, NULL);
  pthread_create(&two, NULL, set_dirty, NULL);
  pthread_join(one, NULL);
  pthread_join(two, NULL);
  if (!flags.open || !flags.dirty) {
    fprintf(stderr, "open %d, dirty %d\n", flags.open, flags.dirty);
    return 1;
  }
  return 0;
}
