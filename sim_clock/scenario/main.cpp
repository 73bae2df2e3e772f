#include "sim_clock/scenario/command_line.hpp"

int main(int argc, char** argv) { return ltsim::run_command_line(argc, argv); }
