// One iteration of the loop that waits for a program, captured or native: handles signals, windows of the private
// display, and one more descriptor.
#pragma once

#include "nodes/launch/program_supervisor.hpp"
#include "tools/mural/run/run_session.hpp"

namespace mural::cli {

constexpr int kTurnMs = 100;

// Waits at most kTurnMs; extraFd -1: none.
void waitTurn(PreparedRun& run, launch::ProgramSupervisor& program, int extraFd);

// Starts the program of a prepared run. Reports an error and returns false if exec fails.
bool startProgram(PreparedRun& run, launch::ProgramSupervisor& program, Console& console);

} // namespace mural::cli
