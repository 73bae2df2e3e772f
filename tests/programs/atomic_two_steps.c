// Threads count the parts that leave a machine in an atomic counter.
// Bug: load and store are atomic, the addition between them is not; a part can be lost.
// Correction: atomic_fetch_add. Argument: number of threads.

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

enum { threads_max = 128 };

static atomic_int parts;

static void *count_part(void *unused) {
  (void)unused;
#ifdef CORRECTED
  atomic_fetch_add(&parts, 1);
#else
  atomic_store(&parts, atomic_load(&parts) + 1);
#endif
  return NULL;
}

int main(int argc, char **argv) {
  const int count = argc > 1 ? atoi(argv[1]) : 3;
  pthread_t threads[threads_max];
  if (count < 1 || count > threads_max) return 2;
  for (int i = 0; i < count; ++i) pthread_create(&threads[i], NULL, count_part, NULL);
  for (int i = 0; i < count; ++i) pthread_join(threads[i], NULL);
  if (atomic_load(&parts) != count) {
    fprintf(stderr, "%d parts, expected %d\n", atomic_load(&parts), count);
    return 1;
  }
  return 0;
}
