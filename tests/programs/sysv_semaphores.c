// Two threads each need the tape and the disk, which are two semaphores of a System V set.
// Bug: they take them one after the other, in opposite order: deadlock.
// Correction: one semop takes both or none.

#define _XOPEN_SOURCE 700
#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <sys/ipc.h>
#include <sys/sem.h>
#include <sys/types.h>

enum { tape = 0, disk = 1 };

union semun {
  int val;
  struct semid_ds *buf;
  unsigned short *array;
};

static int set;
static atomic_int copies;

static void operate(struct sembuf *operations, size_t count) {
  while (semop(set, operations, count) == -1 && errno == EINTR) continue;
}

static void take_both(unsigned short first, unsigned short second) {
  struct sembuf operations[2] = {{.sem_num = first, .sem_op = -1, .sem_flg = 0},
                                 {.sem_num = second, .sem_op = -1, .sem_flg = 0}};
#ifdef CORRECTED
  operate(operations, 2);
#else
  operate(&operations[0], 1);
  operate(&operations[1], 1);
#endif
}

static void give_both(void) {
  struct sembuf operations[2] = {{.sem_num = tape, .sem_op = 1, .sem_flg = 0},
                                 {.sem_num = disk, .sem_op = 1, .sem_flg = 0}};
  operate(operations, 2);
}

static void *back_up(void *unused) {
  (void)unused;
  take_both(disk, tape);
  atomic_fetch_add(&copies, 1);
  give_both();
  return NULL;
}

static void *restore(void *unused) {
  (void)unused;
  take_both(tape, disk);
  atomic_fetch_add(&copies, 1);
  give_both();
  return NULL;
}

int main(void) {
  unsigned short one_each[2] = {1, 1};
  set = semget(IPC_PRIVATE, 2, 0600);
  if (set == -1 || semctl(set, 0, SETALL, (union semun){.array = one_each}) == -1) {
    perror("semaphores");
    return 2;
  }
  pthread_t threads[2];
  pthread_create(&threads[0], NULL, back_up, NULL);
  pthread_create(&threads[1], NULL, restore, NULL);
  for (int i = 0; i < 2; ++i) pthread_join(threads[i], NULL);
  semctl(set, 0, IPC_RMID);
  if (atomic_load(&copies) != 2) {
    fprintf(stderr, "%d copies\n", atomic_load(&copies));
    return 1;
  }
  return 0;
}
