// One iteration of waiting, for captured and native runs: signals, windows of the private display, and one more
// descriptor.
#pragma once

#include "nodes/launch/program_supervisor.hpp"
#include "tools/mural/run_session.hpp"

namespace mural::cli {

constexpr int kTurnMs = 100;

// Waits at most kTurnMs; extraFd -1: none.
void waitTurn(PreparedRun& run, launch::ProgramSupervisor& program, int extraFd);

// Starts the program of a prepared run. Reports an error and returns false if exec fails.
bool startProgram(PreparedRun& run, launch::ProgramSupervisor& program, Console& console);

} // namespace mural::cli
