// Sensors add samples to a sum and a count under a spin lock; a display divides one by the other.
// Bug: the lock is let go between sum and count; the display sees a sum that does not fit the count.
// Correction: one critical section. Argument: number of sensors.

#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

enum { sensors_max = 128 };

static pthread_spinlock_t spin;
static int sum = 0;
static int count = 0;

static void *sense(void *unused) {
  (void)unused;
  pthread_spin_lock(&spin);
  sum += 10;
#ifndef CORRECTED
  pthread_spin_unlock(&spin);
  pthread_spin_lock(&spin);
#endif
  ++count;
  pthread_spin_unlock(&spin);
  return NULL;
}

static void *display(void *wrong) {
  pthread_spin_lock(&spin);
  const int sum_seen = sum;
  const int count_seen = count;
  pthread_spin_unlock(&spin);
  *(int *)wrong = sum_seen != 10 * count_seen;
  return NULL;
}

int main(int argc, char **argv) {
  const int sensors = argc > 1 ? atoi(argv[1]) : 2;
  pthread_t threads[sensors_max];
  pthread_t reader;
  int wrong = 0;
  if (sensors < 1 || sensors > sensors_max) return 2;
  pthread_spin_init(&spin, PTHREAD_PROCESS_PRIVATE);
  for (int i = 0; i < sensors; ++i) pthread_create(&threads[i], NULL, sense, NULL);
  pthread_create(&reader, NULL, display, &wrong);
  for (int i = 0; i < sensors; ++i) pthread_join(threads[i], NULL);
  pthread_join(reader, NULL);
  pthread_spin_destroy(&spin);
  if (wrong) fprintf(stderr, "the average is not 10\n");
  return wrong;
}
