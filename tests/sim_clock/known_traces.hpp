// Programs whose number of Mazurkiewicz traces is known by hand or formula.
#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "sim_clock/world/world.hpp"

namespace ltsim {

/// A program, and how many traces it has.
struct Known {
  std::string name;
  std::uint64_t traces;
  std::function<void(World&)> body;
};

inline void PrintTo(const Known& known, std::ostream* out) { *out << known.name; }

[[nodiscard]] std::uint64_t factorial(std::uint64_t n);
[[nodiscard]] std::uint64_t choose(std::uint64_t n, std::uint64_t k);

/// Adds `count` tasks, each with its number.
void start_tasks(World& world, std::uint32_t count, const std::function<void(std::uint32_t)>& body);

[[nodiscard]] Known last_zero(std::uint32_t n);
/// Each of them, in several sizes.
[[nodiscard]] std::vector<Known> known_programs();

}  // namespace ltsim
