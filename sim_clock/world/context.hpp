// One thread of control of the simulated world: a stack, and the thread-local storage that goes with it.
//
// A switch changes both, so `thread_local`, errno, pthread_self() and exceptions in flight are right in every
// task. Costs: one jump of Boost.Context and one write of the FS base; bench/ shows the sum.
#pragma once

#include <cstddef>

#include <boost/context/detail/fcontext.hpp>

namespace ltsim {

class Context {
 public:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Prepares to run `entry` on the given stack with the given thread-local storage, from its beginning.
  /// @param stack_top        one past the highest byte
  /// @param thread_pointer   value of the FS base, from TaskStorage
  /// @param entry            called with `argument`; must never return
  void prepare(void* stack_top, std::size_t stack_bytes, void* thread_pointer, void (*entry)(void*),
               void* argument) noexcept;

  /// Makes this the context of the thread that calls, as it runs now.
  void adopt_current() noexcept;

  /// Suspends `from`, the running context, and resumes `to`. Returns when somebody resumes `from`.
  static void switch_between(Context& from, Context& to) noexcept;

 private:
  static void enter(boost::context::detail::transfer_t transfer) noexcept;

  boost::context::detail::fcontext_t resume_point_ = nullptr;
  void* thread_pointer_ = nullptr;
  void (*entry_)(void*) = nullptr;
  void* argument_ = nullptr;
};

}  // namespace ltsim
