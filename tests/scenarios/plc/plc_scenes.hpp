// The scenes that several scenarios share.
#pragma once

#include "tests/scenarios/plc/plc_scene.hpp"

namespace scenarios {

inline constexpr PlcScene troubled_scene{.scans_may_hang = true, .driver_may_fail = true};
inline constexpr PlcScene one_thread_scene{
    .threading = PlcScene::Threading::one, .scans_may_hang = true, .driver_may_fail = true};
inline constexpr PlcScene hanging_scene{.scans_may_hang = true, .only = "I20"};
inline constexpr PlcScene catch_up_scene{
    .period = std::chrono::milliseconds{4}, .catches_up = true, .stalls = 1, .orders = 2};

}  // namespace scenarios
