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

constexpr std::string_view proof_header = "ltsim proof 3";

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
  return fmt::format("{}took      {} s in {} runs\nstates    {}\n{}", head(scenario, options), report.seconds,
                     report.runs, report.states, report.checkpoint);
}

tl::expected<ProveReport, std::string> parse_proof(std::string_view text, std::string_view scenario,
                                                   const ProveOptions& options) {
  if (!text.starts_with(proof_header)) {
    if (text.starts_with("ltsim proof "))
      return tl::unexpected(
          fmt::format("is of another version of this program: it does not begin with \"{}\"", proof_header));
    return tl::unexpected(
        fmt::format("is no interrupted proof: it does not begin with \"{}\"", proof_header));
  }
  const std::string expected = head(scenario, options);
  if (!text.starts_with(expected))
    return tl::unexpected<std::string>(
        "is of another scenario, of other bounds or of another build of this program");
  const std::string rest{text.substr(expected.size())};
  ProveReport report;
  unsigned long long states = 0;
  int header_size = 0;
  if (std::sscanf(rest.c_str(), "took %lf s in %u runs states %llu%n", &report.seconds, &report.runs, &states,
                  &header_size) != 3)
    return tl::unexpected<std::string>("the lines that say what was done so far are missing");
  report.states = states;
  report.checkpoint = rest.substr(std::min(static_cast<std::size_t>(header_size) + 1, rest.size()));
  const auto tree = SearchTree::parse(report.checkpoint);
  if (!tree) return tl::unexpected<std::string>("holds a line that is none of a search");
  report.counts = tree->counts();
  report.done = tree->done();
  return report;
}

}  // namespace ltsim
