// The groups of options of `mural run`. Each reader fills its part of the session from the raw texts, and returns an
// error for the first invalid one. Call them in the order of this file: later ones check against earlier ones.
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/session/session_config.hpp"
#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

constexpr int kMaxNodes = 1024;

// Tiles, and size and place of the wall.
Result<void> readSizes(const RunArguments& a, SessionConfig& c);
// Passes of a frame: stereo, pixel, subpixel, time-multiplex, sort-last, zoom.
Result<void> readPasses(const RunArguments& a, SessionConfig& c);
// The hosts of nodes and their launcher. Returns the choice and its reason, for --explain; empty: no other hosts.
// environment: of this process; it describes the batch job.
Result<std::string> readLaunch(const RunArguments& a, const launch::Environment& environment, SessionConfig& c);
// The nodes of readLaunch(), nodes of this machine, and the stream to them.
Result<void> readNodes(const RunArguments& a, SessionConfig& c);
// --config and the options that select from the file. The file defines wall and nodes; options for them are errors.
Result<void> readConfigFile(const RunArguments& a, RunOptions& options);
// Files that the session writes.
Result<void> readOutput(const RunArguments& a, SessionConfig& c);

// --print-config: returns the configuration file that is equivalent to the options.
Result<std::string> configTextOf(const RunArguments& a, const SessionConfig& c);

} // namespace mural::cli
