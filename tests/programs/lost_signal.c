// main waits until a worker has loaded the configuration.
// Bug: the wait has no predicate; a signal sent before the wait is lost and main waits for ever.
// Correction: wait while the flag is not set.

#include <pthread.h>
#include <stdio.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t loaded_changed = PTHREAD_COND_INITIALIZER;
static int loaded = 0;
static int setting = 0;

static void *load(void *unused) {
  (void)unused;
  pthread_mutex_lock(&lock);
  setting = 42;
  loaded = 1;
  pthread_cond_signal(&loaded_changed);
  pthread_mutex_unlock(&lock);
  return NULL;
}

int main(void) {
  pthread_t loader;
  pthread_create(&loader, NULL, load, NULL);

  pthread_mutex_lock(&lock);
#ifdef CORRECTED
  while (!loaded) pthread_cond_wait(&loaded_changed, &lock);
#else
  pthread_cond_wait(&loaded_changed, &lock);
#endif
  const int seen = setting;
  pthread_mutex_unlock(&lock);

  pthread_join(loader, NULL);
  if (seen != 42) {
    fprintf(stderr, "configuration read before it was loaded: %d\n", seen);
    return 1;
  }
  return 0;
}
