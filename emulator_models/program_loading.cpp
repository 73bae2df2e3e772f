#include "emulator_models/program_loading.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"

namespace emulator_models {
namespace {

/// @return at most one byte more than the compiler takes: it then says that the source is too long
tl::expected<std::string, std::string> read_source(const std::string& path) {
  errno = 0;
  std::ifstream file{path, std::ios::binary};
  std::string text(soft_plc::source_bytes_max + 1, '\0');
  // A folder opens like a file and fails only when it is read.
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())) && (!file.eof() || file.bad()))
    return tl::unexpected(
        fmt::format("{}: cannot be read: {}", path, errno != 0 ? std::strerror(errno) : "no text file"));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

}  // namespace

tl::expected<LoadedProgram, std::string> load_program(const std::string& path, PlantKind plant,
                                                      protocol::fx::Model model) {
  LoadedProgram loaded{.name = path, .program = {}};
  std::string source{program_for(plant)};
  if (path.empty()) {
    loaded.name = fmt::format("the program of {}", to_string(plant));
  } else {
    auto text = read_source(path);
    if (!text) return tl::unexpected(text.error());
    source = std::move(*text);
  }
  auto compiled = soft_plc::compile(source, FxAddressMap{model});
  if (!compiled) return tl::unexpected(fmt::format("{}:{}", loaded.name, to_string(compiled.error())));
  loaded.program = std::move(*compiled);
  return loaded;
}

}  // namespace emulator_models
