// The runs of `mural app-report`: the program without Mural, and by `mural run` with several divisions of the work.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/launch/private_display.hpp"
#include "tools/mural/app_report/runs/program_watch.hpp"
#include "tools/mural/app_report/runs/trace_facts.hpp"
#include "tools/mural/child_runs/bounded_run.hpp"
#include "tools/mural/child_runs/scratch_folder.hpp"

namespace mural::cli {

struct AppRun {
    std::string name;                 // "native", "tiles", "balance", "db"
    std::vector<std::string> options; // of mural run
    std::string skipped;              // reason why it was not performed; empty: it was
    BoundedOutcome outcome;
    nlohmann::json report; // of mural run --report; null: none

    [[nodiscard]] bool performed() const { return skipped.empty(); }
    [[nodiscard]] double number(const char* field) const; // of the report; 0: absent
    [[nodiscard]] int64_t frames() const { return static_cast<int64_t>(number("frames")); }
};

struct AppMeasured {
    std::vector<std::string> program;
    std::string size;                          // --size; empty: the program's own
    std::string refused;                       // reason why no run is possible; empty: none
    double seconds = 0;                        // limit of each run
    std::string machineGl;                     // of the render nodes; empty: unknown
    std::vector<std::string> hiddenExtensions; // of this machine's GL that Mural does not advertise
    AppRun native, tiles, balance, db;
    ProgramSeen seen; // of the native run
    TraceFacts trace; // of the run with tiles
    std::string
        bypassSeen; // how the program draws without the capture library, if it was captured nowhere; may be empty
    std::string nativePicture, wallPicture;
};

struct AppRunsPlan {
    std::vector<std::string> program;
    std::string size; // WxH; empty: the program's own
    double seconds = 10;
    bool pictures = true;
};

class AppRuns {
public:
    // Starts the private display. Errors: no display, no space for files.
    static Result<std::unique_ptr<AppRuns>> open(AppRunsPlan plan);

    // Performs all runs, within 4 * seconds + 20. The files of the result live as long as this object. `progress`
    // receives the name of each run.
    AppMeasured measure(const std::function<void(const std::string&)>& progress);

private:
    AppRuns(AppRunsPlan plan, ScratchFolder scratch, std::unique_ptr<launch::PrivateDisplay> display)
        : plan_(std::move(plan)), scratch_(std::move(scratch)), display_(std::move(display)) {}
    AppRun perform(const std::string& name, std::vector<std::string> options,
                   const std::function<void(pid_t, double)>& watch = {});
    void measureNative(AppMeasured& m);
    void measureTiles(AppMeasured& m);

    AppRunsPlan plan_;
    ScratchFolder scratch_;
    std::unique_ptr<launch::PrivateDisplay> display_;
    Deadline allRuns_ = Deadline::never();
};

} // namespace mural::cli
