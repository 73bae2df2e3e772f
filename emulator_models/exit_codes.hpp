// With what plc-emulator ends.
#pragma once

namespace emulator_models {

inline constexpr int exit_ended = 0;      ///< as asked, by SIGINT or SIGTERM
inline constexpr int exit_usage = 2;      ///< an option, a file or a name that cannot be used
inline constexpr int exit_own_fault = 3;  ///< the system refused something, or an error of the program itself

}  // namespace emulator_models
