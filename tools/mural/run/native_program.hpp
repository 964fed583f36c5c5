// Runs of programs with the native API (mural/mural.hpp): their nodes run the program's own binary, and nothing is
// preloaded.
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/run/run_options.hpp"
#include "tools/mural/run/run_session.hpp"

namespace mural::cli {

// Whether the program's binary needs libmural.so. False for scripts, and for files that cannot be read.
[[nodiscard]] bool usesNativeApi(const launch::ProgramCheck& program);

// Adapts a run to such a program. Requires an empty or valid SessionConfig::nodeProgram; empty: the program itself.
// Errors: an option that such programs exclude; the node program cannot be started.
Result<void> prepareNativeProgram(const RunOptions& options, const launch::ProgramCheck& program, PreparedRun& run);

} // namespace mural::cli
