// Messages are sent on a channel that another thread closes.
// Bug: on a closed channel send returns with the lock held; main then waits for it for ever.
// Correction: unlock on that path too.

#include <pthread.h>
#include <stdio.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int closed = 0;
static int sent = 0;
static int refused = 0;

static int send_message(void) {
  pthread_mutex_lock(&lock);
  if (closed) {
    ++refused;
#ifdef CORRECTED
    pthread_mutex_unlock(&lock);
#endif
    return -1;
  }
  ++sent;
  pthread_mutex_unlock(&lock);
  return 0;
}

static void *talk(void *unused) {
  (void)unused;
  for (int i = 0; i < 2; ++i) {
    if (send_message() != 0) break;
  }
  return NULL;
}

static void *hang_up(void *unused) {
  (void)unused;
  pthread_mutex_lock(&lock);
  closed = 1;
  pthread_mutex_unlock(&lock);
  return NULL;
}

int main(void) {
  pthread_t talker, closer;
  pthread_create(&talker, NULL, talk, NULL);
  pthread_create(&closer, NULL, hang_up, NULL);
  pthread_join(talker, NULL);
  pthread_join(closer, NULL);
  pthread_mutex_lock(&lock);
  const int wrong = sent != 2 && refused != 1;
  pthread_mutex_unlock(&lock);
  if (wrong) fprintf(stderr, "%d sent, %d refused\n", sent, refused);
  return wrong;
}
