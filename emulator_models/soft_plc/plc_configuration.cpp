#include "emulator_models/soft_plc/plc_configuration.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "emulator_models/soft_plc/il_address.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/il_cycle.hpp"
#include "emulator_models/soft_plc/signal_recorder.hpp"
#include "emulator_models/soft_plc/toml_table.hpp"
#include "protocol/toml_nesting.hpp"

namespace emulator_models::soft_plc {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t hour_ms = 3'600'000;
constexpr std::size_t drivers_max = 16;
constexpr std::size_t realtime_signals_max = 1024;

/// @return { first_byte, bytes } or { first_word, words } of the table under the key, in bytes
Section section_of(TomlTable& table, const std::string& key, const std::string& unit, std::size_t unit_bytes,
                   std::size_t area_bytes) {
  if (!table.has(key)) return {};
  TomlTable inner = table.table(key);
  const auto units = static_cast<std::int64_t>(area_bytes / unit_bytes);
  const auto first = static_cast<std::size_t>(inner.required_integer("first_" + unit, 0, units - 1));
  const auto count = static_cast<std::size_t>(inner.required_integer(unit + "s", 1, units));
  inner.refuse_the_rest();
  const Section section{first * unit_bytes, count * unit_bytes};
  if (!section.fits(area_bytes))
    refuse(table.region(key), fmt::format("{} ends beyond the area, which has {} {}s", key, units, unit));
  return section;
}

std::vector<std::string> addresses_of(TomlTable& table, std::string_view key, std::size_t addresses_max) {
  std::vector<std::string> addresses = table.texts(key);
  if (addresses.size() > addresses_max)
    refuse(table.region(key), fmt::format("{} names more than {} addresses", key, addresses_max));
  for (const std::string& address : addresses) {
    if (const auto parsed = parse_address(address); !parsed)
      refuse(table.region(key), fmt::format("{}: {}", address, parsed.error()));
  }
  return addresses;
}

ArchiveSettings archive_of(TomlTable& table, const std::filesystem::path& folder) {
  ArchiveSettings archive;
  if (table.has("path")) {
    archive.path = (folder / table.required_text("path")).string();
    const toml::source_position& place = table.region("path").begin;
    archive.path_place = {place.line, place.column};
  }
  archive.rows_max = table.integer("rows_max", archive.rows_max, 1000, 1'000'000'000);
  archive.signals = addresses_of(table, "signals", SignalRecorder::signals_max);
  for (const std::string& address : archive.signals) {
    if (parse_address(address)->type != ElementaryType::boolean)
      refuse(table.region("signals"),
             fmt::format("{} is no bit; the archive has changes of bits, as \"%QX0.3\"", address));
  }
  table.refuse_the_rest();
  return archive;
}

class Parser {
 public:
  Parser(std::filesystem::path folder, const FileReader& reader)
      : folder_{std::move(folder)}, reader_{reader} {}

  PlcConfiguration parse(const toml::table& root) {
    TomlTable file{root, "the file"};
    TomlTable plc = file.table("plc");
    result_.threading =
        plc.one_of("threads", {"one", "per-cycle"}) == 0 ? PlcThreading::one : PlcThreading::per_cycle;
    result_.realtime = plc.boolean("realtime", false);
    outputs_in_stop_ =
        plc.one_of("outputs_in_stop", {"safe", "hold"}) == 0 ? OutputsInStop::safe : OutputsInStop::hold;
    for (const std::int64_t interval : plc.integers("slice_intervals_ms", 0, hour_ms))
      result_.slice_intervals.emplace_back(milliseconds{interval});
    if (result_.slice_intervals.empty()) result_.slice_intervals.emplace_back(0);
    plc.refuse_the_rest();

    std::vector<TomlTable> cycles = file.tables("cycle");
    if (cycles.empty() || cycles.size() > cycles_max)
      refuse(root.source(), fmt::format("a PLC has 1 to {} cycles; give each under [[cycle]]", cycles_max));
    for (TomlTable& cycle : cycles) add_cycle(cycle);
    check_owners(cycles);
    std::vector<TomlTable> drivers = file.tables("driver");
    if (drivers.size() > drivers_max)
      refuse(root.source(), fmt::format("there are more than {} drivers", drivers_max));
    for (TomlTable& driver : drivers) add_driver(driver);

    TomlTable gateway = file.table("gateway");
    result_.gateway.queue_max = static_cast<std::size_t>(gateway.integer("queue_max", 32, 1, 1024));
    result_.gateway.requests_per_scan_max =
        static_cast<std::size_t>(gateway.integer("requests_per_scan_max", 8, 1, 1024));
    result_.answer_timeout = milliseconds{gateway.integer("answer_timeout_ms", 500, 1, 60'000)};
    gateway.refuse_the_rest();

    TomlTable archive = file.table("archive");
    result_.archive = archive_of(archive, folder_);
    TomlTable realtime_data = file.table("realtime_data");
    result_.realtime_signals = addresses_of(realtime_data, "signals", realtime_signals_max);
    realtime_data.refuse_the_rest();
    file.refuse_the_rest();
    return std::move(result_);
  }

 private:
  void add_cycle(TomlTable& table) {
    ConfiguredCycle cycle;
    cycle.name = table.required_text("name");
    if (!names_.insert("cycle " + cycle.name).second)
      refuse(table.region("name"), fmt::format("there is a cycle {} already; names are unique", cycle.name));
    ScanConfig& scan = cycle.config.scan;
    scan.period = milliseconds{table.required_integer("period_ms", 0, hour_ms)};
    scan.watchdog_limit =
        milliseconds{table.integer("watchdog_ms", Watchdog::limit_default.count(), 1, hour_ms)};
    constexpr OverrunRule rules[] = {OverrunRule::skip, OverrunRule::stop, OverrunRule::catch_up};
    scan.overrun = rules[table.one_of("overrun", {"skip", "stop", "catch-up"})];
    scan.outputs_in_stop = outputs_in_stop_;
    cycle.config.priority = static_cast<std::size_t>(
        table.integer("priority", 0, 0, static_cast<std::int64_t>(result_.slice_intervals.size()) - 1));
    cycle.sends = section_of(table, "sends", "word", 2, memory_bytes_max);
    read_program(table, cycle);
    table.refuse_the_rest();
    result_.cycles.push_back(std::move(cycle));
  }

  void read_program(TomlTable& table, ConfiguredCycle& cycle) {
    cycle.program_path = (folder_ / table.required_text("program")).string();
    const toml::source_region& place = table.region("program");
    auto source = reader_(cycle.program_path);
    if (!source)
      refuse(place, fmt::format("{} cannot be read; check the path, which is relative to this file",
                                cycle.program_path));
    auto program = compile(*source);
    if (!program)
      refuse(place, fmt::format("does not compile: {}:{}", cycle.program_path, to_string(program.error())));
    const auto& needed = program->image_bytes_needed;
    if (needed[static_cast<std::size_t>(Area::inputs)] > inputs_bytes_max ||
        needed[static_cast<std::size_t>(Area::outputs)] > outputs_bytes_max ||
        needed[static_cast<std::size_t>(Area::memory)] > memory_bytes_max)
      refuse(place, fmt::format("{} uses addresses beyond %IB{}, %QB{} or %MB{}", cycle.program_path,
                                inputs_bytes_max - 1, outputs_bytes_max - 1, memory_bytes_max - 1));
    cycle.source = std::move(*source);
    cycle.program = std::move(*program);
  }

  /// Each word and each output has one writer; the place in the program is named.
  void check_owners(const std::vector<TomlTable>& tables) const {
    const auto& cycles = result_.cycles;
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      for (std::size_t k = 0; k < cycles.size(); ++k) {
        if (i == k) continue;
        if (k < i && cycles[i].sends.overlaps(cycles[k].sends))
          refuse(tables[i].region("sends"),
                 fmt::format("cycle {} sends some of these words; each word has one owner, move one of them",
                             cycles[k].name));
        check_writes(tables[i], cycles[i], cycles[k]);
      }
    }
  }

  static void check_writes(const TomlTable& table, const ConfiguredCycle& writer,
                           const ConfiguredCycle& owner) {
    const IlProgram& program = writer.program;
    for (std::size_t i = 0; i < program.code.size(); ++i) {
      const Instruction& in = program.code[i];
      if (in.area != Area::memory || !writes_operand(in) || !owner.sends.overlaps(operand_section(in)))
        continue;
      refuse(table.region("program"),
             fmt::format("{}:{}:{}: writes a word that cycle {} sends; only its owner may write it",
                         writer.program_path, program.places[i].line, program.places[i].column, owner.name));
    }
  }

  void add_driver(TomlTable& table) {
    ConfiguredDriver driver;
    DriverConfig& config = driver.config;
    config.name = table.required_text("name");
    if (!names_.insert("driver " + config.name).second)
      refuse(table.region("name"),
             fmt::format("there is a driver {} already; names are unique", config.name));
    driver.kind = table.required_text("kind");
    config.period = milliseconds{table.required_integer("period_ms", 1, hour_ms)};
    config.late_after = milliseconds{table.integer("late_ms", 100, 1, hour_ms)};
    config.failures_max = static_cast<std::uint32_t>(table.integer("failures_max", 3, 1, 1'000'000));
    config.stale_is_fault = table.one_of("on_stale", {"count", "fault"}) == 1;
    config.inputs = section_of(table, "inputs", "byte", 1, inputs_bytes_max);
    for (const ConfiguredDriver& other : result_.drivers) {
      if (other.config.inputs.overlaps(config.inputs))
        refuse(table.region("inputs"),
               fmt::format("driver {} brings some of these inputs; move one of them", other.config.name));
    }
    for (const std::int64_t value : table.integers("fixed_inputs", 0, 255))
      driver.fixed_inputs.push_back(static_cast<std::byte>(value));
    if (!driver.fixed_inputs.empty() && driver.kind != "simulated")
      refuse(table.region("fixed_inputs"), "fixed_inputs belongs to kind \"simulated\"; leave it out");
    if (driver.fixed_inputs.size() > config.inputs.bytes)
      refuse(table.region("fixed_inputs"), fmt::format("fixed_inputs has {} bytes, but inputs only {}",
                                                       driver.fixed_inputs.size(), config.inputs.bytes));
    if (table.has("stale_bit")) config.stale_bit = stale_bit(table);
    table.refuse_the_rest();
    result_.drivers.push_back(std::move(driver));
  }

  static std::size_t stale_bit(TomlTable& table) {
    const std::string address = table.required_text("stale_bit");
    const auto parsed = parse_address(address);
    if (!parsed || parsed->area != Area::inputs || parsed->type != ElementaryType::boolean ||
        parsed->byte_index >= inputs_bytes_max)
      refuse(table.region("stale_bit"),
             fmt::format("stale_bit must be an input up to %IX{}.7, as \"%IX63.0\"", inputs_bytes_max - 1));
    return parsed->byte_index * std::size_t{8} + parsed->bit_index;
  }

  std::filesystem::path folder_;
  const FileReader& reader_;
  OutputsInStop outputs_in_stop_ = OutputsInStop::safe;
  std::set<std::string> names_;
  PlcConfiguration result_;
};

std::string at(const std::string& file_name, const toml::source_position& place, std::string_view message) {
  return fmt::format("{}:{}:{}: {}", file_name, place.line, place.column, message);
}

}  // namespace

std::optional<std::string> read_file(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  std::string text(source_bytes_max + 1, '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())) && !file.eof()) return std::nullopt;
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

tl::expected<PlcConfiguration, std::string> parse_configuration(std::string_view text,
                                                                const std::string& file_name,
                                                                const FileReader& reader) {
  return parse_configuration(text, file_name, std::filesystem::path{file_name}.parent_path(), reader);
}

tl::expected<PlcConfiguration, std::string> parse_configuration(std::string_view text,
                                                                const std::string& name,
                                                                const std::filesystem::path& folder,
                                                                const FileReader& reader) {
  if (text.size() > configuration_bytes_max)
    return tl::unexpected{fmt::format("{}:1:1: longer than {} bytes; a configuration is a few hundred lines",
                                      name, configuration_bytes_max)};
  if (const auto place = protocol::too_deep_nesting(text))
    return tl::unexpected{fmt::format("{}:{}:{}: this nests deeper than {} levels; no key here needs as many",
                                      name, place->line, place->column, protocol::toml_nesting_max)};
  try {
    return Parser{folder, reader}.parse(toml::parse(text, name));
  } catch (const ConfigurationFailure& failure) {
    return tl::unexpected{at(name, failure.place, failure.message)};
  } catch (const toml::parse_error& error) {
    return tl::unexpected{at(name, error.source().begin, error.description())};
  }
}

}  // namespace emulator_models::soft_plc
