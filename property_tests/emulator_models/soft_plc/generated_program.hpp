// Programs in instruction list that have types: a tape of bytes is read, each byte a decision, and what comes of it always
// compiles. An empty tape is the smallest program, so a shorter tape with smaller bytes makes a smaller program.
//
// Left out: REAL and LREAL, direct addresses.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "emulator_models/soft_plc/il_types.hpp"

namespace property_tests {

using emulator_models::soft_plc::ElementaryType;

/// Any value of 64 bits, with or without a sign; sums and differences of two of them.
__extension__ typedef __int128 Wide;

/// Decisions, one a byte; 0 for ever behind its end.
class Tape {
 public:
  explicit Tape(std::span<const std::uint8_t> bytes) : bytes_{bytes} {}

  [[nodiscard]] bool is_at_end() const noexcept { return bytes_.empty(); }
  /// @return 0 to count - 1
  std::size_t choose(std::size_t count) noexcept;
  bool flip() noexcept { return choose(2) == 1; }

 private:
  std::span<const std::uint8_t> bytes_;
};

struct Expression {
  enum class Kind : std::uint8_t {
    variable,
    literal,
    binary,
    complement,
    absolute,
    convert,
    extreme,
    limit,
    select,
    shift
  };

  Kind kind = Kind::literal;
  ElementaryType type = ElementaryType::boolean;
  std::string word;         ///< the variable's name, or the operator: "ANDN", "MIN", "SHL"
  Wide value = 0;           ///< of a literal
  bool short_form = false;  ///< of a binary one: "ADD( a" and not "ADD(", "LD a"
  std::vector<Expression> parts;
};

struct Statement {
  enum class Kind : std::uint8_t {
    store,
    store_not,
    set,
    reset,
    if_true,
    if_false,
    loop,
    return_if,
    call_ton,
    call_ctu,
    call_r_trig,
    call_sr
  };

  Kind kind = Kind::store;
  std::string target;
  std::vector<Expression> operands;  ///< the value or the condition; of a call, its inputs in order
  std::vector<Statement> body;
  unsigned times = 0;  ///< of a loop, which counts in `target`
};

struct GeneratedProgram {
  struct Variable {
    std::string name;
    ElementaryType type;
  };
  std::vector<Variable> variables;
  std::vector<Statement> statements;
};

/// Instances of the program: T1 : TON, C1 : CTU, E1 : R_TRIG, L1 : SR.
[[nodiscard]] GeneratedProgram program_of(Tape& tape);
[[nodiscard]] std::string source_of(const GeneratedProgram& program);

}  // namespace property_tests
