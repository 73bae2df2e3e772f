// A sender puts a message into a mailbox in POSIX shared memory and posts its semaphore.
// Bug: the post comes after the length but before the words; the receiver may read old words.
// Correction: everything is stored before the post.

#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

struct mailbox {
  sem_t full;
  _Atomic uint32_t length;
  _Atomic uint32_t words[2];
};

static struct mailbox *open_mailbox(void) {
  char name[32];
  snprintf(name, sizeof name, "/mailbox-%ld", (long)getpid());
  const int file = shm_open(name, O_CREAT | O_EXCL | O_RDWR, 0600);
  if (file == -1) return NULL;
  shm_unlink(name);
  void *memory = MAP_FAILED;
  if (ftruncate(file, sizeof(struct mailbox)) == 0)
    memory = mmap(NULL, sizeof(struct mailbox), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (memory == MAP_FAILED) return NULL;
  struct mailbox *mailbox = memory;
  sem_init(&mailbox->full, 1, 0);
  return mailbox;
}

static void *send_message(void *argument) {
  struct mailbox *mailbox = argument;
  atomic_store(&mailbox->length, 2);
#ifndef CORRECTED
  sem_post(&mailbox->full);
#endif
  atomic_store(&mailbox->words[0], 7);
  atomic_store(&mailbox->words[1], 8);
#ifdef CORRECTED
  sem_post(&mailbox->full);
#endif
  return NULL;
}

int main(void) {
  struct mailbox *mailbox = open_mailbox();
  if (mailbox == NULL) {
    perror("mailbox");
    return 2;
  }
  pthread_t sender;
  pthread_create(&sender, NULL, send_message, mailbox);
  while (sem_wait(&mailbox->full) == -1 && errno == EINTR) continue;
  uint32_t sum = 0;
  const uint32_t length = atomic_load(&mailbox->length);
  for (uint32_t i = 0; i < length; ++i) sum += atomic_load(&mailbox->words[i]);
  pthread_join(sender, NULL);
  sem_destroy(&mailbox->full);
  munmap(mailbox, sizeof *mailbox);
  if (sum != 15) {
    fprintf(stderr, "sum %u\n", (unsigned)sum);
    return 1;
  }
  return 0;
}
