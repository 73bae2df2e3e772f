#include "car_park.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

CarPark::CarPark(const char* segment) {
  const int descriptor = ::shm_open(segment, O_RDWR, 0);
  if (descriptor < 0) throw std::system_error{errno, std::generic_category(), segment};
  void* const memory =
      ::mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  const int error = errno;
  ::close(descriptor);
  if (memory == MAP_FAILED) throw std::system_error{error, std::generic_category(), segment};
  free_places_ = static_cast<std::atomic<int>*>(memory);
}

CarPark::~CarPark() { ::munmap(free_places_, sizeof *free_places_); }

bool CarPark::let_in_after_a_look() {
  if (free_places_->load() == 0) return false;
  free_places_->fetch_sub(1);
  return true;
}

bool CarPark::let_in() {
  int free = free_places_->load();
  while (free > 0) {
    if (free_places_->compare_exchange_weak(free, free - 1)) return true;
  }
  return false;
}
