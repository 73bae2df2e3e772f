// A connection is closed by the user thread and by the watchdog thread, whichever comes first.
// Bug: the closed flag is tested and set in two steps; both threads free the buffer.
// Correction: one atomic exchange.

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

struct connection {
  atomic_bool closed;
  char *buffer;
};

static struct connection connection;

static void *close_connection(void *unused) {
  (void)unused;
#ifdef CORRECTED
  if (atomic_exchange(&connection.closed, 1)) return NULL;
#else
  if (atomic_load(&connection.closed)) return NULL;
  atomic_store(&connection.closed, 1);
#endif
  free(connection.buffer);
  return NULL;
}

int main(void) {
  connection.buffer = malloc(64);
  if (connection.buffer == NULL) return 2;
  pthread_t user, watchdog;
  pthread_create(&user, NULL, close_connection, NULL);
  pthread_create(&watchdog, NULL, close_connection, NULL);
  pthread_join(user, NULL);
  pthread_join(watchdog, NULL);
  return 0;
}
