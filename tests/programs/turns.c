// Three threads take turns in the order of their numbers.
// Bug: cnd_signal may wake a thread whose turn it is not; it sleeps again and the right one is not told.
// Correction: cnd_broadcast.

#include <stdint.h>
#include <stdio.h>
#include <threads.h>

enum { players = 3 };

static mtx_t lock;
static cnd_t turn_changed;
static int turn = 0;

static int play(void *argument) {
  const int self = (int)(intptr_t)argument;
  mtx_lock(&lock);
  while (turn != self) cnd_wait(&turn_changed, &lock);
  ++turn;
#ifdef CORRECTED
  cnd_broadcast(&turn_changed);
#else
  cnd_signal(&turn_changed);
#endif
  mtx_unlock(&lock);
  return 0;
}

int main(void) {
  mtx_init(&lock, mtx_plain);
  cnd_init(&turn_changed);
  thrd_t threads[players];
  for (intptr_t i = 0; i < players; ++i) {
    if (thrd_create(&threads[i], play, (void *)i) != thrd_success) return 2;
  }
  for (int i = 0; i < players; ++i) thrd_join(threads[i], NULL);
  cnd_destroy(&turn_changed);
  mtx_destroy(&lock);
  if (turn != players) {
    fprintf(stderr, "%d turns\n", turn);
    return 1;
  }
  return 0;
}
