// FUZZ_TARGET(): a function that takes bytes which somebody else wrote.
//
//     #include "sim_clock/scenario/fuzz_target.hpp"
//
//     FUZZ_TARGET("fx-frame", {}, "one frame of the programming port, decoded and encoded again") {
//       const auto request = decode_request(input);
//       if (request) ltsim::expect(encode(*request) == input, "what decodes encodes to the same bytes");
//     }
//
// One function, four ways to run it: by a fuzzing engine (fuzz-NAME in a build with LTSIM_FUZZ_ENGINE), over files and folders
// (fuzz-NAME in any other build), as the scenario "fuzz/NAME" of a program with ltsim's command line, where the bytes are
// the schedule's "input" lines, and by a test that calls find_fuzz_target().
//
// A target fails by expect(), by any other exception, by a signal, by a sanitizer's report. Nothing here needs the simulated
// world: targets are built in builds without it, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ltsim {

/// What a target promised does not hold.
struct BrokenPromise : std::logic_error {
  using std::logic_error::logic_error;
};

/// @throw BrokenPromise unless `holds`
inline void expect(bool holds, const char* promise) {
  if (!holds) throw BrokenPromise{promise};
}

/// Changes the first `size` of `data` in place, as the engine does where a target has no mutator of its own.
/// @return the new size, at most data.size()
using PlainMutator = std::size_t (*)(std::span<std::byte> data, std::size_t size);

/// How the bytes of a target are made of records, if they are.
struct InputFormat {
  /// The input cut into records: together they are the input again. What makes an input small takes whole records away,
  /// and a schedule shows one a line.
  std::vector<std::string_view> (*split)(std::string_view input) = nullptr;
  /// Makes a new input of a given one, in place, for formats with sums or lengths; null: the engine's own way.
  /// @param size   bytes of `data` that are the input
  /// @param seed   of the changes: equal seeds make equal inputs
  /// @param plain  the engine's own way, for parts of the input
  /// @return       the new size, at most data.size()
  std::size_t (*mutate)(std::span<std::byte> data, std::size_t size, unsigned seed,
                        PlainMutator plain) = nullptr;
  /// Makes a new input of two; null: the engine's own way.
  /// @return the bytes of `into` that are the new one; 0: none was made
  std::size_t (*splice)(std::span<const std::byte> one, std::span<const std::byte> other,
                        std::span<std::byte> into, unsigned seed) = nullptr;
};

struct FuzzTarget;
struct Schedule;

/// What a target has besides where its bytes are the choices of a scenario (fuzz_scenario.hpp).
struct FuzzedScenario {
  /// Steers the scenario of that name from now on, in place of the target's own.
  /// @return whether this program has it
  bool (*steer)(std::string_view scenario) = nullptr;
  /// @return the choices that the bytes made, as a small schedule with its outcome
  Schedule (*record)(const FuzzTarget& target, std::span<const std::byte> input) = nullptr;
  /// @throw BrokenPromise unless the outcome is `passed`
  /// @return what no longer fits of the schedule; empty if all does
  std::string (*replay)(const Schedule& schedule) = nullptr;
};

struct FuzzTarget {
  std::string_view
      name;  ///< one word: of the program fuzz-NAME, of folder corpus/NAME, of scenario fuzz/NAME
  std::string_view description;
  InputFormat format;
  void (*run)(std::span<const std::byte> input);
  FuzzedScenario scenario = {};

  /// Whether it needs the simulated world: the bytes are choices.
  [[nodiscard]] bool needs_world() const noexcept { return scenario.replay != nullptr; }
  /// The records of an input; without a format of its own it is cut behind each end of a line.
  [[nodiscard]] std::vector<std::string_view> records(std::string_view input) const;
};

/// Cut behind each '\n'.
[[nodiscard]] std::vector<std::string_view> lines_as_records(std::string_view input);

/// All targets of this program, by name.
[[nodiscard]] const std::vector<FuzzTarget>& fuzz_targets();
/// @return null if there is none of that name
[[nodiscard]] const FuzzTarget* find_fuzz_target(std::string_view name);

/// Adds a target before main(). A name given twice ends the program with exit code 2.
struct FuzzTargetRegistration {
  FuzzTargetRegistration(std::string_view name, const InputFormat& format, std::string_view description,
                         void (*run)(std::span<const std::byte> input), const FuzzedScenario& scenario = {});
};

}  // namespace ltsim

#define LTSIM_FUZZ_JOIN_(a, b) a##b
#define LTSIM_FUZZ_JOIN(a, b) LTSIM_FUZZ_JOIN_(a, b)

// The format may hold commas, so it and what follows it are one variadic argument.
#define FUZZ_TARGET(name, ...)                                                               \
  static void LTSIM_FUZZ_JOIN(ltsim_fuzz_, __LINE__)(std::span<const std::byte> input);      \
  static const ::ltsim::FuzzTargetRegistration LTSIM_FUZZ_JOIN(ltsim_fuzz_added_, __LINE__){ \
      name, __VA_ARGS__, &LTSIM_FUZZ_JOIN(ltsim_fuzz_, __LINE__)};                           \
  static void LTSIM_FUZZ_JOIN(ltsim_fuzz_, __LINE__)([[maybe_unused]] std::span<const std::byte> input)
