// Whoever comes first makes the semaphore of a store, and says that one part lies in it; a producer puts one more in, and a
// consumer takes two (System V shared memory and semaphores).
// Bug: a set counts from 0 until its maker sets it; what the producer has put in before that is overwritten.
// Correction: the maker adds to the count what lies in the store at first.

#define _XOPEN_SOURCE 700
#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <sys/ipc.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <unistd.h>

struct store {
  _Atomic int parts;
};

static key_t key;
static int segment;

static void change(int set, short by) {
  struct sembuf operation = {.sem_num = 0, .sem_op = by, .sem_flg = 0};
  while (semop(set, &operation, 1) == -1 && errno == EINTR) continue;
}

static int open_semaphore(void) {
  const int set = semget(key, 1, IPC_CREAT | IPC_EXCL | 0600);
  if (set == -1) return semget(key, 1, 0600);
#ifdef CORRECTED
  change(set, 1);
#else
  semctl(set, 0, SETVAL, 1);
#endif
  return set;
}

static void *produce(void *argument) {
  (void)argument;
  struct store *store = shmat(segment, NULL, 0);
  const int set = open_semaphore();
  atomic_fetch_add(&store->parts, 1);
  change(set, 1);
  shmdt(store);
  return NULL;
}

static void *consume(void *argument) {
  (void)argument;
  struct store *store = shmat(segment, NULL, 0);
  const int set = open_semaphore();
  for (int i = 0; i < 2; ++i) {
    change(set, -1);
    atomic_fetch_sub(&store->parts, 1);
  }
  shmdt(store);
  return NULL;
}

int main(void) {
  key = (key_t)(0x4c540000 + getpid() % 0xffff);
  segment = shmget(IPC_PRIVATE, sizeof(struct store), IPC_CREAT | 0600);
  if (segment == -1) {
    perror("shmget");
    return 2;
  }
  struct store *store = shmat(segment, NULL, 0);
  shmctl(segment, IPC_RMID, NULL);
  atomic_store(&store->parts, 1);
  pthread_t producer;
  pthread_t consumer;
  pthread_create(&producer, NULL, produce, NULL);
  pthread_create(&consumer, NULL, consume, NULL);
  pthread_join(producer, NULL);
  pthread_join(consumer, NULL);
  const int left = atomic_load(&store->parts);
  semctl(semget(key, 1, 0600), 0, IPC_RMID);
  return left == 0 ? 0 : 1;
}
