// Three modules of a server - cache, index, log - each lock themselves and then call the next one.
// Bug: the calls form a ring (cache, index, log, cache), no two of them deadlock, all three do.
// Correction: the log takes the cache before itself, so that all follow one order.

#include <pthread.h>
#include <stdio.h>

static pthread_mutex_t cache_lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_mutex_t index_lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_mutex_t log_lock = PTHREAD_MUTEX_INITIALIZER;
static int cache_entries = 10, index_entries = 10, log_entries = 10;

static void move_one(pthread_mutex_t *first, pthread_mutex_t *second, int *from, int *to) {
  pthread_mutex_lock(first);
  pthread_mutex_lock(second);
  --*from;
  ++*to;
  pthread_mutex_unlock(second);
  pthread_mutex_unlock(first);
}

static void *evict(void *unused) {
  (void)unused;
  move_one(&cache_lock, &index_lock, &cache_entries, &index_entries);
  return NULL;
}

static void *compact(void *unused) {
  (void)unused;
  move_one(&index_lock, &log_lock, &index_entries, &log_entries);
  return NULL;
}

static void *replay(void *unused) {
  (void)unused;
#ifdef CORRECTED
  move_one(&cache_lock, &log_lock, &log_entries, &cache_entries);
#else
  move_one(&log_lock, &cache_lock, &log_entries, &cache_entries);
#endif
  return NULL;
}

int main(void) {
  pthread_t threads[3];
  pthread_create(&threads[0], NULL, evict, NULL);
  pthread_create(&threads[1], NULL, compact, NULL);
  pthread_create(&threads[2], NULL, replay, NULL);
  for (int i = 0; i < 3; ++i) pthread_join(threads[i], NULL);
  if (cache_entries != 10 || index_entries != 10 || log_entries != 10) {
    fprintf(stderr, "entries: %d, %d, %d\n", cache_entries, index_entries, log_entries);
    return 1;
  }
  return 0;
}
