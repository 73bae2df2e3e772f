// A worker keeps its statistics in thread-specific storage; main shows them while the worker runs.
// Bug: main reads the pointer and then the statistics; if the worker ends in between they are freed.
// Correction: main reads both under a lock that the destructor takes before it frees.

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

struct statistics {
  atomic_int pieces;
};

static pthread_key_t key;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct statistics *_Atomic shown;

static void forget(void *statistics) {
  pthread_mutex_lock(&lock);
  atomic_store(&shown, NULL);
  pthread_mutex_unlock(&lock);
  free(statistics);
}

static void *work(void *unused) {
  (void)unused;
  struct statistics *own = malloc(sizeof *own);
  if (own == NULL) abort();
  atomic_init(&own->pieces, 1);
  pthread_setspecific(key, own);
  atomic_store(&shown, own);
  return NULL;
}

static int show(void) {
#ifdef CORRECTED
  pthread_mutex_lock(&lock);
#endif
  struct statistics *seen = atomic_load(&shown);
  const int pieces = seen == NULL ? 0 : atomic_load(&seen->pieces);
#ifdef CORRECTED
  pthread_mutex_unlock(&lock);
#endif
  return pieces;
}

int main(void) {
  pthread_t worker;
  if (pthread_key_create(&key, forget) != 0) return 2;
  pthread_create(&worker, NULL, work, NULL);
  const int pieces = show();
  pthread_join(worker, NULL);
  pthread_key_delete(key);
  if (pieces != 0 && pieces != 1) {
    fprintf(stderr, "%d pieces\n", pieces);
    return 1;
  }
  return 0;
}
