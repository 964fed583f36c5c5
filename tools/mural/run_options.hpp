// The command line of `mural run`, as a value.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "nodes/session/session_config.hpp"

namespace CLI {
class App;
}

namespace mural::cli {

// Whether GL libraries that GLVND does not lead to are caught as well.
enum class FrontChoice { Auto, Glvnd, Preload };

struct RunOptions {
    SessionConfig config;       // all but session and displayName
    bool displayChosen = false; // --display was given
    FrontChoice front = FrontChoice::Auto;
    bool native = false;
    bool quiet = false;
    std::string configText;           // --print-config: the configuration that the options stand for; empty: not asked for
    std::vector<std::string> notices; // what the configuration file should be mended in
    std::string reportFile;           // --report; empty: none
    std::vector<std::string> program; // name and arguments
};

// The texts as they stand on the command line; checked and converted by runOptionsFrom.
struct RunArguments {
    using Text = std::optional<std::string>;
    Text tiles, tileQueue, chunkQueue, size, position, nodes, out, save, display, tiling, policy, gl, launch, stream, remoteMural, front, restartNodes, leastNodes;
    Text config, canvas, frusta, modelUnit, economy, store;
    std::vector<std::string> layouts;
    bool here = false, printConfig = false;
    Text stereo, eyeBase, focus, pixel, subpixel, dplex, db, zoom, composition, codec, readback;
    Text localNodes, frames, latency, report, record;
    std::string verify; // empty: not given
    bool fullScreen = false, noPlacement = false, explain = false, native = false, quiet = false;
    std::vector<std::string> program;
};

// Adds the options to the sub-command; `arguments` must outlive the parsing.
void describeRunOptions(CLI::App& command, RunArguments& arguments);

// One error, for the first argument that is wrong.
Result<RunOptions> runOptionsFrom(const RunArguments& arguments);

} // namespace mural::cli
