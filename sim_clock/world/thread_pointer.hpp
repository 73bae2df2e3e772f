// The FS base of the running thread: where its thread-local storage ends and its control block begins.
#pragma once

namespace ltsim {

inline void* current_thread_pointer() noexcept {
  void* value = nullptr;
  asm volatile("mov %%fs:0, %0" : "=r"(value));  // the x86-64 ABI keeps the pointer to itself there
  return value;
}

}  // namespace ltsim
