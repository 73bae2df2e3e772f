// Four workers store a part of a sum and meet at a barrier; then the last of them adds the parts up.
// Bug: the barrier is made for two, a number left from an earlier version; the sum may come too early.
// Correction: the barrier counts all workers.

#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>

enum { workers = 4 };

static pthread_barrier_t all_stored;
static atomic_int parts[workers];
static atomic_int sum;

static void *work(void *argument) {
  const intptr_t self = (intptr_t)argument;
  atomic_store(&parts[self], 1);
  pthread_barrier_wait(&all_stored);
  if (self == workers - 1) {
    for (int i = 0; i < workers; ++i) atomic_fetch_add(&sum, atomic_load(&parts[i]));
  }
  return NULL;
}

int main(void) {
#ifdef CORRECTED
  pthread_barrier_init(&all_stored, NULL, workers);
#else
  pthread_barrier_init(&all_stored, NULL, 2);
#endif
  pthread_t threads[workers];
  for (intptr_t i = 0; i < workers; ++i) pthread_create(&threads[i], NULL, work, (void *)i);
  for (int i = 0; i < workers; ++i) pthread_join(threads[i], NULL);
  pthread_barrier_destroy(&all_stored);
  if (atomic_load(&sum) != workers) {
    fprintf(stderr, "sum %d\n", atomic_load(&sum));
    return 1;
  }
  return 0;
}
