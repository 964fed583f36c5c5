#include "tools/mural/accuracy/program_rows.hpp"
#include "tools/mural/accuracy/progress.hpp"

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace mural::cli {

namespace {

struct ProgramMethod {
    const char* name;
    Words options;
    Bound bound;
    bool quick;
};

std::vector<ProgramMethod> programMethods() {
    const Bound exact = Bound::exact(), notPromised{}; // the error of tiling lean depends on the program's drawing
    return {
        {"2D, 2x2 tiles", {"--tiles", "2x2"}, exact, true},
        {"2D, 7x5 unequal tiles on 4 nodes", {"--tiles", "7x5", "--local-nodes", "4"}, exact, false},
        {"2D, tiling culled, 3x2", {"--tiles", "3x2", "--tiling", "culled"}, exact, false},
        {"DB, 3 ranges", {"--db", "3"}, exact, true},
        {"mixed: 2x1 tiles of 2 ranges", {"--tiles", "2x1", "--db", "2", "--local-nodes", "4"}, exact, false},
        {"2D, tiling lean, 2x2", {"--tiles", "2x2", "--tiling", "lean"}, notPromised, true},
    };
}

// Reads the counts of --verify, which include alpha.
Result<MeasuredError> errorOfReport(const std::string& path) {
    std::ifstream file(path);
    const auto report = nlohmann::json::parse(file, nullptr, false);
    const auto number = [&](const char* name) {
        return report.is_object() && report.contains(name) && report[name].is_number() ? report[name].get<int64_t>()
                                                                                       : 0;
    };
    MeasuredError e;
    e.pixels = number("verifiedPixels");
    e.differing = number("differingPixels");
    e.largest = static_cast<double>(number("largestDifference"));
    e.squares = static_cast<double>(number("squaredDifference"));
    e.components = 4 * e.pixels;
    if (e.pixels == 0)
        return Error{"no frame was compared; the program must draw with OpenGL for the requested number of frames"};
    return e;
}

} // namespace

void measureProgram(const AccuracyRuns& runs, const Words& program, int64_t frames, bool quick,
                    std::vector<AccuracyRow>& rows) {
    for (const ProgramMethod& method : programMethods()) {
        if (quick && !method.quick) continue;
        reportProgress(method.name);
        AccuracyRow row{"Decompositions", method.name, "its own context", {}, method.bound, {}};
        auto folder = ScratchFolder::make();
        const std::string report = folder ? folder->path() + "/report.json" : "";
        Words options = method.options;
        options.insert(options.end(), {"--verify", "--frames", std::to_string(frames), "--report", report});
        const auto done = folder ? runs.mural(options, program, frames) : Result<std::string>(folder.error());
        const auto error = done ? errorOfReport(report) : Result<MeasuredError>(done.error());
        if (error)
            row.error = error.value();
        else
            row.failure = error.error().message;
        rows.push_back(row);
    }
}

} // namespace mural::cli
