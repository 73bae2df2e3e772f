// Two jobs each need two of two licences.
// Bug: they take the licences one at a time; with one each, both wait for ever.
// Correction: only one job at a time may be taking licences.

#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>

static sem_t licences;
#ifdef CORRECTED
static pthread_mutex_t taking = PTHREAD_MUTEX_INITIALIZER;
#endif

static void take_licence(void) {
  while (sem_wait(&licences) == -1 && errno == EINTR) continue;
}

static void *run_job(void *done) {
#ifdef CORRECTED
  pthread_mutex_lock(&taking);
#endif
  take_licence();
  take_licence();
#ifdef CORRECTED
  pthread_mutex_unlock(&taking);
#endif
  *(int *)done = 1;
  sem_post(&licences);
  sem_post(&licences);
  return NULL;
}

int main(void) {
  pthread_t jobs[2];
  int done[2] = {0, 0};
  sem_init(&licences, 0, 2);
  for (int i = 0; i < 2; ++i) pthread_create(&jobs[i], NULL, run_job, &done[i]);
  for (int i = 0; i < 2; ++i) pthread_join(jobs[i], NULL);
  sem_destroy(&licences);
  if (!done[0] || !done[1]) {
    fprintf(stderr, "a job was not done\n");
    return 1;
  }
  return 0;
}
