// One turn of waiting, shared by captured and native runs: signals, the private display's windows and
// one more descriptor.
#pragma once

#include "nodes/launch/program_supervisor.hpp"
#include "tools/mural/run_session.hpp"

namespace mural::cli {

constexpr int kTurnMs = 100;

// Waits at most kTurnMs; extraFd −1: none.
void waitTurn(PreparedRun& run, launch::ProgramSupervisor& program, int extraFd);

// Starts the program of a prepared run; complains and returns false when exec fails.
bool startProgram(PreparedRun& run, launch::ProgramSupervisor& program, Console& console);

} // namespace mural::cli
