// The command line of `mural run` as a value.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/session/session_config.hpp"
#include "tools/mural/run/option_values.hpp"

namespace CLI {
class App;
}

namespace mural::cli {

// Selects whether GL libraries outside of GLVND are captured as well.
enum class EntryChoice { Auto, Glvnd, Preload };

struct RunOptions {
    SessionConfig config;       // everything except session and displayName
    bool displayChosen = false; // --display was given
    EntryChoice captureVia = EntryChoice::Auto;
    bool native = false;
    bool quiet = false;
    std::string configText;           // --print-config: equivalent configuration; empty: not requested
    std::vector<std::string> notices; // warnings about the configuration file
    std::string reportFile;           // --report; empty: none
    std::string page;                 // --page: address of the page; empty: none
    std::string launchChoice;         // the launcher and the reason, for --explain; empty: no other hosts
    std::vector<std::string> program; // name and arguments
};

// Raw texts of the command line, validated by runOptionsFrom().
struct RunArguments {
    OptionText tiles, tileQueue, chunkQueue, balance, size, position, nodes, out, save, display, tiling, culling,
        localRendering, gl, gpus, launch, stream, hostFile, perHost, startTimeout, launchSecret, slurm, remoteMural,
        nodeProgram, captureVia, restartNodes, minNodes, spareNodes;
    OptionText config, canvas, projection, modelUnit, delta, cacheSize;
    std::vector<std::string> layouts;
    std::vector<std::string> sends;
    bool allLocal = false, printConfig = false;
    bool startsNodes = false; // a new session: without nodes in the options, the batch job gives them
    OptionText stereo, eyeBase, focus, pixel, subpixel, dplex, db, zoom, composition, codec, readback;
    OptionText localNodes, frames, latency, report, record, frameTimes, overlay, windowInput;
    std::string verify; // empty: not given
    std::string page;   // empty: not given
    bool fullScreen = false, noPlacement = false, overlayInFiles = false, explain = false, native = false,
         quiet = false;
    std::vector<std::string> program;
};

// Adds the options to the subcommand; `arguments` must outlive the parsing.
void describeRunOptions(CLI::App& command, RunArguments& arguments);
// The same for the options that divide the work, which describeRunOptions() includes.
void describePlanOptions(CLI::App& command, RunArguments& arguments);

// Returns one error, for the first invalid argument.
Result<RunOptions> runOptionsFrom(const RunArguments& arguments);

} // namespace mural::cli
