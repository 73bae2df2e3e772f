// Visitors use a lift if it is free, else they take the stairs.
// Bug: those on the stairs unlock the lift too, which another one holds (EPERM, the mutex checks).
// Correction: unlock only what was locked.

#define _XOPEN_SOURCE 700
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

static pthread_mutex_t lift;
static int rides = 0;
static atomic_int walks;
static atomic_int errors;

static void *go_up(void *unused) {
  (void)unused;
  const int got_it = pthread_mutex_trylock(&lift) == 0;
  if (got_it)
    ++rides;
  else
    atomic_fetch_add(&walks, 1);
#ifdef CORRECTED
  if (got_it && pthread_mutex_unlock(&lift) != 0) atomic_fetch_add(&errors, 1);
#else
  if (pthread_mutex_unlock(&lift) != 0) atomic_fetch_add(&errors, 1);
#endif
  return NULL;
}

int main(void) {
  pthread_mutexattr_t checked;
  pthread_mutexattr_init(&checked);
  pthread_mutexattr_settype(&checked, PTHREAD_MUTEX_ERRORCHECK);
  pthread_mutex_init(&lift, &checked);
  pthread_mutexattr_destroy(&checked);
  pthread_t visitors[2];
  for (int i = 0; i < 2; ++i) pthread_create(&visitors[i], NULL, go_up, NULL);
  for (int i = 0; i < 2; ++i) pthread_join(visitors[i], NULL);
  pthread_mutex_destroy(&lift);
  if (atomic_load(&errors) != 0 || rides + atomic_load(&walks) != 2) {
    fprintf(stderr, "%d errors, %d rides, %d walks\n", atomic_load(&errors), rides, atomic_load(&walks));
    return 1;
  }
  return 0;
}
