// The scenes that several scenarios share.
#pragma once

#include "tests/scenarios/plc/plc_scene.hpp"

namespace scenarios {

inline constexpr PlcScene troubled_scene{.hang = PlcScene::Hang::may, .driver_may_fail = true};
inline constexpr PlcScene one_thread_scene{
    .threading = PlcScene::Threading::one, .hang = PlcScene::Hang::may, .driver_may_fail = true};
inline constexpr PlcScene hanging_scene{.hang = PlcScene::Hang::may, .only = "I20"};
inline constexpr PlcScene realtime_scene{.period = std::chrono::milliseconds{1},
                                         .watchdog_limit = std::chrono::microseconds{150},
                                         .realtime = true,
                                         .hang = PlcScene::Hang::second_scan,
                                         .orders = 0,
                                         .only = "I20"};
inline constexpr PlcScene restarted_scene{.threading = PlcScene::Threading::one,
                                          .period = std::chrono::milliseconds{20},
                                          .watchdog_limit = std::chrono::milliseconds{45},
                                          .hang = PlcScene::Hang::second_scan,
                                          .panel = PlcScene::Operator::acknowledges,
                                          .orders = 6,
                                          .only = "I21"};
inline constexpr PlcScene catch_up_scene{
    .period = std::chrono::milliseconds{4}, .catches_up = true, .stalls = 1, .orders = 2};

inline constexpr PlcScene gateway_scene{.hang = PlcScene::Hang::may, .field_requests = 4, .only = "gateway"};
inline constexpr PlcScene gateway_one_thread_scene{.threading = PlcScene::Threading::one,
                                                   .hang = PlcScene::Hang::may,
                                                   .field_requests = 4,
                                                   .only = "gateway"};

}  // namespace scenarios
