// A clerk books a deposit while two auditors read the balance twice; the clerk waits 3 ms at most.
// Bug: the clerk does not look whether he got the lock; he books, and unlocks, while an auditor holds it.
// Correction: without the lock the deposit is put off.

#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdio.h>
#include <time.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int balance = 100;
static int put_off = 0;
static int wrong[2];

static void *clerk(void *unused) {
  (void)unused;
  struct timespec deadline;
  clock_gettime(CLOCK_REALTIME, &deadline);
  deadline.tv_nsec += 3000000;
  if (deadline.tv_nsec >= 1000000000) {
    deadline.tv_nsec -= 1000000000;
    ++deadline.tv_sec;
  }
#ifdef CORRECTED
  if (pthread_mutex_timedlock(&lock, &deadline) != 0) {
    put_off = 20;
    return NULL;
  }
#else
  pthread_mutex_timedlock(&lock, &deadline);
#endif
  balance += 20;
  pthread_mutex_unlock(&lock);
  return NULL;
}

static void *audit(void *changed) {
  const struct timespec printing = {.tv_sec = 0, .tv_nsec = 2000000};
  pthread_mutex_lock(&lock);
  const int before = balance;
  nanosleep(&printing, NULL);
  *(int *)changed = balance != before;
  pthread_mutex_unlock(&lock);
  return NULL;
}

int main(void) {
  pthread_t threads[3];
  pthread_create(&threads[0], NULL, clerk, NULL);
  pthread_create(&threads[1], NULL, audit, &wrong[0]);
  pthread_create(&threads[2], NULL, audit, &wrong[1]);
  for (int i = 0; i < 3; ++i) pthread_join(threads[i], NULL);
  if (wrong[0] || wrong[1] || balance + put_off != 120) {
    fprintf(stderr, "the balance changed during an audit, or is wrong: %d\n", balance);
    return 1;
  }
  return 0;
}
