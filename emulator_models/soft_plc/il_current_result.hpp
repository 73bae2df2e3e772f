// What the compiler knows about the CR at one place of the program.
#pragma once

#include <cstdint>

#include "emulator_models/soft_plc/il_types.hpp"

namespace emulator_models::soft_plc {

struct CurrentResult {
  enum class State : std::uint8_t {
    unreached,  ///< no way leads here, as far as is known
    undefined,  ///< nothing loaded yet, or ways that disagree
    untyped,    ///< made of literals that wait for a type: LD 5
    typed,
  };

  State state = State::unreached;
  ElementaryType type = ElementaryType::boolean;  ///< when typed
  bool after_call = false;  ///< a CAL came since the last load: edition 2 does not say what CR is then

  [[nodiscard]] static CurrentResult undefined() noexcept { return {State::undefined, {}, false}; }
  [[nodiscard]] static CurrentResult of(ElementaryType type) noexcept { return {State::typed, type, false}; }

  friend bool operator==(const CurrentResult&, const CurrentResult&) = default;
};

/// What holds where two ways meet. An untyped CR does not survive that: its type would depend on the way.
[[nodiscard]] inline CurrentResult merged(const CurrentResult& a, const CurrentResult& b) noexcept {
  using State = CurrentResult::State;
  const auto settled = [](const CurrentResult& cr) {
    return cr.state == State::untyped ? CurrentResult::undefined() : cr;
  };
  if (a.state == State::unreached) return settled(b);
  if (b.state == State::unreached) return settled(a);
  if (a.state != State::typed || b.state != State::typed || a.type != b.type)
    return CurrentResult::undefined();
  return {State::typed, a.type, a.after_call || b.after_call};
}

}  // namespace emulator_models::soft_plc
