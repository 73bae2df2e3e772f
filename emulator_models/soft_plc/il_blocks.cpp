#include "emulator_models/soft_plc/il_blocks.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <type_traits>

#include "emulator_models/soft_plc/function_blocks.hpp"

namespace emulator_models::soft_plc {
namespace {

constexpr ElementaryType b = ElementaryType::boolean;
constexpr ElementaryType i = ElementaryType::int_;
constexpr ElementaryType t = ElementaryType::time;

static_assert(sizeof(std::chrono::nanoseconds) == 8, "a TIME");

constexpr std::array<BlockParameter, 3> sr_parameters{
    {{"S1", b, offsetof(Sr, s1), true}, {"R", b, offsetof(Sr, r), true}, {"Q1", b, offsetof(Sr, q1), false}}};
constexpr std::array<BlockParameter, 3> rs_parameters{
    {{"S", b, offsetof(Rs, s), true}, {"R1", b, offsetof(Rs, r1), true}, {"Q1", b, offsetof(Rs, q1), false}}};
constexpr std::array<BlockParameter, 2> r_trig_parameters{
    {{"CLK", b, offsetof(RTrig, clk), true}, {"Q", b, offsetof(RTrig, q), false}}};
constexpr std::array<BlockParameter, 2> f_trig_parameters{
    {{"CLK", b, offsetof(FTrig, clk), true}, {"Q", b, offsetof(FTrig, q), false}}};
constexpr std::array<BlockParameter, 5> ctu_parameters{{{"CU", b, offsetof(Ctu, cu), true},
                                                        {"R", b, offsetof(Ctu, r), true},
                                                        {"PV", i, offsetof(Ctu, pv), true},
                                                        {"Q", b, offsetof(Ctu, q), false},
                                                        {"CV", i, offsetof(Ctu, cv), false}}};
constexpr std::array<BlockParameter, 5> ctd_parameters{{{"CD", b, offsetof(Ctd, cd), true},
                                                        {"LD", b, offsetof(Ctd, ld), true},
                                                        {"PV", i, offsetof(Ctd, pv), true},
                                                        {"Q", b, offsetof(Ctd, q), false},
                                                        {"CV", i, offsetof(Ctd, cv), false}}};
constexpr std::array<BlockParameter, 8> ctud_parameters{{{"CU", b, offsetof(Ctud, cu), true},
                                                         {"CD", b, offsetof(Ctud, cd), true},
                                                         {"R", b, offsetof(Ctud, r), true},
                                                         {"LD", b, offsetof(Ctud, ld), true},
                                                         {"PV", i, offsetof(Ctud, pv), true},
                                                         {"QU", b, offsetof(Ctud, qu), false},
                                                         {"QD", b, offsetof(Ctud, qd), false},
                                                         {"CV", i, offsetof(Ctud, cv), false}}};
template <typename Timer>
constexpr std::array<BlockParameter, 4> timer_parameters{{{"IN", b, offsetof(Timer, in), true},
                                                          {"PT", t, offsetof(Timer, pt), true},
                                                          {"Q", b, offsetof(Timer, q), false},
                                                          {"ET", t, offsetof(Timer, et), false}}};

constexpr BlockParameter contact_output{"Q", b, 0, false, ParameterHome::contact};
constexpr BlockParameter value_output{"CV", i, 0, false, ParameterHome::value};
constexpr std::array<BlockParameter, 4> device_timer_parameters{{{"IN", b, offsetof(DeviceTimer, in), true},
                                                                 {"PV", i, offsetof(DeviceTimer, pv), true},
                                                                 contact_output,
                                                                 value_output}};
constexpr std::array<BlockParameter, 5> retentive_timer_parameters{
    {{"IN", b, offsetof(DeviceTimer, in), true},
     {"R", b, offsetof(DeviceTimer, r), true},
     {"PV", i, offsetof(DeviceTimer, pv), true},
     contact_output,
     value_output}};
constexpr std::array<BlockParameter, 5> device_counter_parameters{
    {{"CU", b, offsetof(DeviceCounter, cu), true},
     {"R", b, offsetof(DeviceCounter, r), true},
     {"PV", i, offsetof(DeviceCounter, pv), true},
     contact_output,
     value_output}};
constexpr std::array<BlockParameter, 5> wide_counter_parameters{
    {{"CU", b, offsetof(WideDeviceCounter, cu), true},
     {"R", b, offsetof(WideDeviceCounter, r), true},
     {"PV", ElementaryType::dint, offsetof(WideDeviceCounter, pv), true},
     contact_output,
     {"CV", ElementaryType::dint, 0, false, ParameterHome::value}}};

struct RetentiveTimer : DeviceTimer {
  void call(std::byte* memory, std::chrono::nanoseconds now) noexcept { call_retentive(memory, now); }
};

template <typename Block>
void construct_block(std::byte* instance, const BlockDevices& devices) noexcept {
  static_assert(std::is_trivially_copyable_v<Block>, "instances are started anew by copying bytes");
  static_assert(alignof(Block) <= block_alignment);
  auto* const block = new (instance) Block{};
  if constexpr (requires { block->devices; }) block->devices = devices;
}

template <typename Block>
void call_block(std::byte* instance, [[maybe_unused]] std::byte* memory,
                [[maybe_unused]] std::chrono::nanoseconds now) noexcept {
  auto& block = *std::launder(reinterpret_cast<Block*>(instance));
  if constexpr (requires { block.call(memory, now); }) {
    block.call(memory, now);
  } else if constexpr (requires { block.call(memory); }) {
    block.call(memory);
  } else if constexpr (requires { block.call(now); }) {
    block.call(now);
  } else {
    block.call();
  }
}

struct BlockFacts {
  std::string_view name;
  std::span<const BlockParameter> parameters;
  std::size_t bytes;
  void (*construct)(std::byte*, const BlockDevices&) noexcept;
  void (*call)(std::byte*, std::byte*, std::chrono::nanoseconds) noexcept;
};

template <typename Block>
constexpr BlockFacts facts(std::string_view name, std::span<const BlockParameter> parameters) {
  return {name, parameters, sizeof(Block), &construct_block<Block>, &call_block<Block>};
}

/// In the order of BlockKind.
constexpr std::array<BlockFacts, 14> blocks{
    facts<Sr>("SR", sr_parameters),
    facts<Rs>("RS", rs_parameters),
    facts<RTrig>("R_TRIG", r_trig_parameters),
    facts<FTrig>("F_TRIG", f_trig_parameters),
    facts<Ctu>("CTU", ctu_parameters),
    facts<Ctd>("CTD", ctd_parameters),
    facts<Ctud>("CTUD", ctud_parameters),
    facts<Ton>("TON", timer_parameters<Ton>),
    facts<Tof>("TOF", timer_parameters<Tof>),
    facts<Tp>("TP", timer_parameters<Tp>),
    facts<DeviceTimer>("timer", device_timer_parameters),
    facts<RetentiveTimer>("retentive timer", retentive_timer_parameters),
    facts<DeviceCounter>("counter", device_counter_parameters),
    facts<WideDeviceCounter>("32-bit counter", wide_counter_parameters)};

const BlockFacts& facts_of(BlockKind kind) noexcept { return blocks[static_cast<std::size_t>(kind)]; }

}  // namespace

std::optional<BlockKind> block_kind(std::string_view upper_name) noexcept {
  constexpr auto declarable_count = static_cast<std::size_t>(BlockKind::device_timer);
  for (std::size_t index = 0; index < declarable_count; ++index) {
    if (blocks[index].name == upper_name) return static_cast<BlockKind>(index);
  }
  return std::nullopt;
}

std::string_view name_of(BlockKind kind) noexcept { return facts_of(kind).name; }

std::span<const BlockParameter> parameters_of(BlockKind kind) noexcept { return facts_of(kind).parameters; }

const BlockParameter* parameter_of(BlockKind kind, std::string_view upper_name) noexcept {
  for (const BlockParameter& parameter : parameters_of(kind)) {
    if (parameter.name == upper_name) return &parameter;
  }
  return nullptr;
}

bool is_input_operator(std::string_view upper_operation) noexcept {
  constexpr std::array<std::string_view, 10> operators{"IN", "PT", "CLK", "CU", "CD",
                                                       "R",  "PV", "S1",  "S",  "R1"};
  return std::ranges::find(operators, upper_operation) != operators.end();
}

std::size_t instance_bytes(BlockKind kind) noexcept { return facts_of(kind).bytes; }

void construct(BlockKind kind, std::byte* instance, const BlockDevices& devices) noexcept {
  facts_of(kind).construct(instance, devices);
}

void call(BlockKind kind, std::byte* instance, std::byte* memory, std::chrono::nanoseconds now) noexcept {
  facts_of(kind).call(instance, memory, now);
}

}  // namespace emulator_models::soft_plc
