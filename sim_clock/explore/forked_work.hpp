// Work in a process forked for it: what it does to this process's memory, to libraries and to descriptors is gone with it.
//
// Carried back is what the work hands over, and what it writes to memory that both share (SharedMemory). The parent waits meanwhile:
// at most one such process lives.
//
// A process that dies takes this one with it, in the same way: whoever waits for this one learns how the work ended.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "sim_clock/explore/carried_bytes.hpp"
#include "sim_clock/explore/memory_across_forks.hpp"

namespace ltsim {

class ForkedWork {
 public:
  /// What one piece of work can hand over at most: the choices of a long execution, and its output.
  static constexpr std::size_t handed_over_bytes_max = std::size_t{1} << 28U;

  /// @return what `work` has returned, in a process forked for it
  /// @throw  Refusal that the work has thrown; std::runtime_error in place of any other exception; std::system_error if there is no
  ///         process to be had
  template <typename Result, typename Refusal>
  Result run(const std::function<Result()>& work) {
    enum class End : std::uint8_t { nothing, returned, refused, threw };
    End end = End::nothing;
    BytesOut{handed_over_.bytes()}(end);
    run_apart([&] {
      BytesOut out{handed_over_.bytes()};
      try {
        Result result = work();
        out(end = End::returned, result);
      } catch (Refusal& refusal) {
        out = BytesOut{handed_over_.bytes()};
        out(end = End::refused, refusal.message);
      } catch (const std::exception& error) {
        std::string what = error.what();
        out = BytesOut{handed_over_.bytes()};
        out(end = End::threw, what);
      }
    });
    BytesIn in{handed_over_.bytes()};
    in(end);
    if (end == End::nothing) die_of(0);
    if (end == End::returned) {
      Result result{};
      in(result);
      return result;
    }
    std::string message;
    in(message);
    if (end == End::refused) throw Refusal{std::move(message)};
    throw std::runtime_error{message};
  }

  /// The process that is at work; 0: none. For signal handlers.
  [[nodiscard]] static pid_t process() noexcept { return process_; }
  /// Processes that were forked so far. In one of them: which it is, from 1.
  [[nodiscard]] static std::uint64_t processes_count() noexcept { return processes_count_; }

 private:
  /// @param status  of wait(2)
  [[noreturn]] static void die_of(int status) noexcept;
  void run_apart(const std::function<void()>& work);
  [[nodiscard]] static pid_t fork_beside() noexcept;

  static inline volatile pid_t process_ = 0;
  static inline volatile std::uint64_t processes_count_ = 0;

  SharedMemory handed_over_{handed_over_bytes_max};
};

}  // namespace ltsim
