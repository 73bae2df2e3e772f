// rand(3), random(3), drand48(3) and what seeds them: in a task, those of its process. What is given its state by the caller (rand_r,
// nrand48, random_r ...) is libc's own.

#include <cerrno>
#include <cstdint>
#include <cstdlib>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

ltsim::RandomNumbers::Generators& generators() { return current_task->world->random_numbers().of_current(); }

long draw() noexcept {
  std::int32_t number = 0;
  random_r(&generators().of_random, &number);
  return number;
}

/// What initstate(3) and setstate(3) return: the table of before, which begins with a word of its type.
char* table_of(const random_data& of) noexcept { return reinterpret_cast<char*>(of.state - 1); }

}  // namespace

extern "C" int rand() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(rand)();
  return static_cast<int>(draw());
}

extern "C" void srand(unsigned seed) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(srand)(seed);
  srandom_r(seed, &generators().of_random);
}

extern "C" long random() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(random)();
  return draw();
}

extern "C" void srandom(unsigned seed) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(srandom)(seed);
  srandom_r(seed, &generators().of_random);
}

extern "C" char* initstate(unsigned seed, char* table, std::size_t bytes) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(initstate)(seed, table, bytes);
  random_data& of = generators().of_random;
  char* const before = table_of(of);
  return initstate_r(seed, table, bytes, &of) == 0 ? before : nullptr;
}

extern "C" char* setstate(char* table) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(setstate)(table);
  random_data& of = generators().of_random;
  char* const before = table_of(of);
  return setstate_r(table, &of) == 0 ? before : nullptr;
}

extern "C" double drand48() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(drand48)();
  double number = 0;
  drand48_r(&generators().of_drand48, &number);
  return number;
}

extern "C" long lrand48() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(lrand48)();
  long number = 0;
  lrand48_r(&generators().of_drand48, &number);
  return number;
}

extern "C" long mrand48() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(mrand48)();
  long number = 0;
  mrand48_r(&generators().of_drand48, &number);
  return number;
}

extern "C" void srand48(long seed) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(srand48)(seed);
  srand48_r(seed, &generators().of_drand48);
}

extern "C" unsigned short* seed48(unsigned short* seed) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(seed48)(seed);
  seed48_r(seed, &generators().of_drand48);
  return generators().of_drand48.__old_x;
}

extern "C" void lcong48(unsigned short* parameters) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(lcong48)(parameters);
  lcong48_r(parameters, &generators().of_drand48);
}
