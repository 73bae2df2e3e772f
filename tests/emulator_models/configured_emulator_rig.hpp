// Files for plc-emulator --config: a folder of its own for each test.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace emulator_models {

/// A folder with a configuration of two cycles; the second runs `program`.
struct ConfiguredEmulator : testing::Test {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("ltsim-configured-" + std::to_string(::getpid()));
  const std::string path = (folder / "plc.toml").string();

  ConfiguredEmulator() {
    std::filesystem::create_directory(folder);
    write("good.il", "PROGRAM good\nVAR n AT %MW0 : INT; END_VAR\nLD n\nADD 1\nST n\nEND_PROGRAM\n");
  }
  ~ConfiguredEmulator() override { std::filesystem::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const { std::ofstream{folder / name} << text; }
  void configure(const std::string& program, const std::string& threads = "one", int period_ms = 10) const {
    write("plc.toml", "[plc]\nthreads = \"" + threads +
                          "\"\n[[cycle]]\nname = \"fast\"\nprogram = \"good.il\"\nperiod_ms = 1\n"
                          "[[cycle]]\nname = \"slow\"\nprogram = \"" +
                          program + "\"\nperiod_ms = " + std::to_string(period_ms) + "\n");
  }
};

}  // namespace emulator_models
