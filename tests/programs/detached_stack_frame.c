// Clients hand a request on their own stack to a detached thread and wait until it is done.
// Bug: all clients wait on one semaphore; one may be woken by the other's thread, and its frame and the
// text in it are gone while its own thread still works. Correction: a semaphore in each request.

#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct request {
#ifdef CORRECTED
  sem_t done;
#endif
  char *text;
  size_t length;
};

#ifndef CORRECTED
static sem_t done;
#endif

static void *measure(void *argument) {
  struct request *request = argument;
  request->length = strlen(request->text);
#ifdef CORRECTED
  sem_post(&request->done);
#else
  sem_post(&done);
#endif
  return NULL;
}

static void wait_for(sem_t *semaphore) {
  while (sem_wait(semaphore) == -1 && errno == EINTR) continue;
}

static void *client(void *wrong) {
  struct request request = {.text = malloc(8), .length = 0};
  if (request.text == NULL) abort();
  strcpy(request.text, "12345");
#ifdef CORRECTED
  sem_init(&request.done, 0, 0);
#endif
  pthread_attr_t detached;
  pthread_attr_init(&detached);
  pthread_attr_setdetachstate(&detached, PTHREAD_CREATE_DETACHED);
  pthread_t helper;
  pthread_create(&helper, &detached, measure, &request);
  pthread_attr_destroy(&detached);
#ifdef CORRECTED
  wait_for(&request.done);
  sem_destroy(&request.done);
#else
  wait_for(&done);
#endif
  if (request.length != 5) *(int *)wrong = 1;
  free(request.text);
  return NULL;
}

int main(void) {
#ifndef CORRECTED
  sem_init(&done, 0, 0);
#endif
  pthread_t clients[2];
  int wrong[2] = {0, 0};
  for (int i = 0; i < 2; ++i) pthread_create(&clients[i], NULL, client, &wrong[i]);
  for (int i = 0; i < 2; ++i) pthread_join(clients[i], NULL);
#ifndef CORRECTED
  sem_destroy(&done);
#endif
  if (wrong[0] || wrong[1]) {
    fprintf(stderr, "a request was answered before it was done\n");
    return 1;
  }
  return 0;
}
