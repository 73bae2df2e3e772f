// The configuration of a soft PLC: read from TOML, checked in full before anything is built of it.
//
// A file is good as a whole or refused as a whole, with file:line:column, the reason and the way out: unknown keys, wrong
// types, values out of range, programs that cannot be read or do not compile, two owners of one word. Files are read
// through a FileReader, so that nothing here knows a disk.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_program.hpp"
#include "emulator_models/soft_plc/plc_threads.hpp"

namespace emulator_models::soft_plc {

/// Longest configuration, in bytes.
inline constexpr std::size_t configuration_bytes_max = 1'048'576;

struct ConfiguredCycle {
  std::string name;
  std::string program_path;
  std::string source;
  IlProgram program;
  CycleConfig config;
  Section sends;  ///< of %M, in bytes
};

struct ConfiguredDriver {
  std::string kind;  ///< means something to the DriverFactory only
  DriverConfig config;
  std::vector<std::byte> fixed_inputs{};  ///< of kind "simulated"; at most as many as config.inputs has
};

/// Of the archive, which is built elsewhere (configured_plc.hpp).
struct ArchiveSettings {
  std::string path;  ///< empty: no archive
  SourcePlace path_place;
  std::int64_t rows_max = 1'000'000;
  std::vector<std::string> signals;  ///< addresses of bits, as "%QX0.3"
};

struct PlcConfiguration {
  PlcThreading threading = PlcThreading::one;
  bool realtime = false;
  std::vector<std::chrono::nanoseconds> slice_intervals;
  std::vector<ConfiguredCycle> cycles;
  std::vector<ConfiguredDriver> drivers;
  GatewayLimits gateway;
  std::chrono::milliseconds answer_timeout{500};
  ArchiveSettings archive;
  std::vector<std::string> realtime_signals;  ///< addresses whose values can be read at any time
};

/// @return the bytes of the file; none if it cannot be read
using FileReader = std::function<std::optional<std::string>(const std::string& path)>;
/// From the disk; of a longer file, a byte more than a source may have.
[[nodiscard]] std::optional<std::string> read_file(const std::string& path);

/// @param text       TOML
/// @param file_name  stands in front of errors; paths in the file are relative to its folder
/// @return           the configuration; or "file:line:column: reason and way out"
[[nodiscard]] tl::expected<PlcConfiguration, std::string> parse_configuration(std::string_view text,
                                                                              const std::string& file_name,
                                                                              const FileReader& reader);
/// For a text that is no file of this folder.
/// @param name    stands in front of errors in place of the file's
/// @param folder  to which paths in the text are relative
[[nodiscard]] tl::expected<PlcConfiguration, std::string> parse_configuration(
    std::string_view text, const std::string& name, const std::filesystem::path& folder,
    const FileReader& reader);

}  // namespace emulator_models::soft_plc
