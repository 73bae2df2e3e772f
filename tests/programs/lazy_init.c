// A table of squares is made when it is first needed.
// Bug: two threads may both find it missing and both make it: a data race, and one table leaks.
// Correction: pthread_once.

#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static int *squares;

static void make_squares(void) {
  int *made = malloc(4 * sizeof *made);
  if (made == NULL) abort();
  for (int i = 0; i < 4; ++i) made[i] = i * i;
  squares = made;
}

#ifdef CORRECTED
static pthread_once_t once = PTHREAD_ONCE_INIT;
#endif

static int square(int value) {
#ifdef CORRECTED
  pthread_once(&once, make_squares);
#else
  if (squares == NULL) make_squares();
#endif
  return squares[value];
}

static void *ask(void *argument) { return (void *)(intptr_t)square((int)(intptr_t)argument); }

int main(void) {
  pthread_t one, two;
  void *four, *nine;
  pthread_create(&one, NULL, ask, (void *)(intptr_t)2);
  pthread_create(&two, NULL, ask, (void *)(intptr_t)3);
  pthread_join(one, &four);
  pthread_join(two, &nine);
  free(squares);
  if ((intptr_t)four != 4 || (intptr_t)nine != 9) {
    fprintf(stderr, "squares %d and %d\n", (int)(intptr_t)four, (int)(intptr_t)nine);
    return 1;
  }
  return 0;
}
