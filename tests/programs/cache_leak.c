// A cached answer is computed by the first thread that needs it and freed at the end.
// Bug: two threads may both find the cache empty; the second store drops the first answer: a leak.
// Correction: compare and exchange; the loser frees its own answer.

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

static int *_Atomic cached;

static int *compute(void) {
  int *answer = malloc(sizeof *answer);
  if (answer == NULL) abort();
  *answer = 42;
  return answer;
}

static int get(void) {
  int *answer = atomic_load(&cached);
  if (answer == NULL) {
    answer = compute();
#ifdef CORRECTED
    int *other = NULL;
    if (!atomic_compare_exchange_strong(&cached, &other, answer)) {
      free(answer);
      answer = other;
    }
#else
    atomic_store(&cached, answer);
#endif
  }
  return *answer;
}

static void *ask(void *answer) {
  *(int *)answer = get();
  return NULL;
}

int main(void) {
  pthread_t threads[2];
  int answers[2] = {0, 0};
  for (int i = 0; i < 2; ++i) pthread_create(&threads[i], NULL, ask, &answers[i]);
  for (int i = 0; i < 2; ++i) pthread_join(threads[i], NULL);
  free(atomic_load(&cached));
  if (answers[0] != 42 || answers[1] != 42) {
    fprintf(stderr, "answers %d and %d\n", answers[0], answers[1]);
    return 1;
  }
  return 0;
}
