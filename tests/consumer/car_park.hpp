// The free places of a car park, counted in shared memory: each of its gates is a process of its own.
#pragma once

#include <atomic>

class CarPark {
 public:
  /// @param segment  an int, the number of free places, as for shm_open(3)
  /// @throw std::system_error if it cannot be had
  explicit CarPark(const char* segment);
  ~CarPark();
  CarPark(const CarPark&) = delete;
  CarPark& operator=(const CarPark&) = delete;

  /// Takes a place if there is one. It looks first and takes then: of the last place, so may another gate between.
  /// @return whether a car may go in
  bool let_in_after_a_look();
  /// Takes a place if there is one, and does so in one step.
  /// @return whether a car may go in
  bool let_in();

 private:
  std::atomic<int>* free_places_;
};
