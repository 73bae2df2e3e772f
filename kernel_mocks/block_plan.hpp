// What a block means for the PLC: which functions, in which order, before or after its motion.
//
// Order of a block: S, T and the first M function that acts at the begin, together under one FIN; the other M
// functions of the begin, one by one; the motion; the M functions of the end, one by one; then the program
// flow (stop, end). M98 never comes here: the parser refuses it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "kernel_mocks/machine_table.hpp"
#include "kernel_mocks/nc_error.hpp"
#include "kernel_mocks/nc_program.hpp"

namespace kernel_mocks {

/// What one handshake with the PLC carries; at least one of the three.
struct FunctionRequest {
  std::optional<std::uint16_t> m;
  std::optional<std::uint16_t> s;
  std::optional<std::uint16_t> t;
  Acknowledgement acknowledgement = Acknowledgement::before_going_on;
  /// Of the M function.
  SpindleEffect spindle = SpindleEffect::none;

  bool operator==(const FunctionRequest&) const = default;
};

/// "M6 T5", "M3 S1500"
[[nodiscard]] std::string to_string(const FunctionRequest& request);

struct BlockPlan {
  std::vector<FunctionRequest> begin;
  std::vector<FunctionRequest> end;
  /// Whether the block moves an axis or dwells.
  bool has_motion = false;
  ProgramFlow flow = ProgramFlow::none;
};

/// @return m_code_not_in_machine_table or does_not_fit_plc_word, with the word, when the machine cannot do it
[[nodiscard]] tl::expected<BlockPlan, NcError> plan_block(
    const Block& block, const MachineTable& table = MachineTable::standard());

/// Plans every block: a program that this machine cannot carry out is refused before anything moves.
[[nodiscard]] tl::expected<void, NcError> check_for_machine(
    const Program& program, const MachineTable& table = MachineTable::standard());

}  // namespace kernel_mocks
