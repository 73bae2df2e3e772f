#include "sim_clock/explore/proof_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <span>

#include <fmt/format.h>

namespace ltsim {
namespace {

constexpr std::string_view proof_header = "ltsim proof 2";

/// Of this program's file: FNV-1a, 64 bits.
std::uint64_t program_hash() {
  std::ifstream file{"/proc/self/exe", std::ios::binary};
  std::uint64_t hash = 0xcbf29ce484222325U;
  std::array<char, 65536> bytes{};
  while (file.read(bytes.data(), bytes.size()), file.gcount() > 0) {
    for (const char byte : std::span{bytes}.first(static_cast<std::size_t>(file.gcount())))
      hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  }
  return hash;
}

std::string head(std::string_view scenario, const ProveOptions& options) {
  return fmt::format("{}\nscenario  {}\nprogram   {:016x}\nbounds    {}, {} looks{}\n", proof_header,
                     scenario, program_hash(), describe_bounds(options), options.bounds.looks,
                     options.bounds.states ? ", states told apart" : "");
}

}  // namespace

std::string to_proof(const ProveReport& report, std::string_view scenario, const ProveOptions& options) {
  return fmt::format(
      "{}counted   {} executions, {} redundant, {} cut off, {} held back, {} points, {} states, {} parts, {} "
      "s\n{}",
      head(scenario, options), report.executions, report.redundant, report.cut_off, report.held_back,
      report.points, report.states, report.parts, report.seconds, report.checkpoint);
}

tl::expected<ProveReport, std::string> parse_proof(std::string_view text, std::string_view scenario,
                                                   const ProveOptions& options) {
  if (!text.starts_with(proof_header))
    return tl::unexpected(
        fmt::format("is no interrupted proof: it does not begin with \"{}\"", proof_header));
  const std::string expected = head(scenario, options);
  if (!text.starts_with(expected))
    return tl::unexpected<std::string>(
        "is of another scenario, of other bounds or of another build of this program");
  const std::string rest{text.substr(expected.size())};
  ProveReport report;
  unsigned long long executions = 0;
  unsigned long long redundant = 0;
  unsigned long long cut_off = 0;
  unsigned long long held_back = 0;
  unsigned long long points = 0;
  unsigned long long states = 0;
  if (std::sscanf(rest.c_str(),
                  "counted %llu executions, %llu redundant, %llu cut off, %llu held back, %llu points, %llu "
                  "states, %u parts, %lf s",
                  &executions, &redundant, &cut_off, &held_back, &points, &states, &report.parts,
                  &report.seconds) != 8)
    return tl::unexpected<std::string>("the line that says what was counted is missing");
  report.executions = executions;
  report.redundant = redundant;
  report.cut_off = cut_off;
  report.held_back = held_back;
  report.points = points;
  report.states = states;
  report.checkpoint = rest.substr(std::min(rest.find('\n') + 1, rest.size()));
  return report;
}

}  // namespace ltsim
