#include "tools/mural/accuracy/resolution_rows.hpp"

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/mural/child_runs/interruption.hpp"
#include "tools/mural/accuracy/progress.hpp"

namespace mural::cli {

namespace {

// A DFR_equalizer whose rate no machine reaches holds its least zoom while the scene moves.
constexpr const char* kConfig = R"(#Equalizer 1.2 ascii
server {{ config {{ appNode {{ pipe {{
    window {{ viewport [ 0 0 {0} {1} ] channel {{ name "screen" }} }}
    window {{ viewport [ 0 0 {0} {1} ] channel {{ name "one" }} }} }} }}
  layout {{ view {{ }} }} canvas {{ layout 0 wall {{ }} segment {{ channel "screen" }} }}
  compound {{ channel ( )
    compound {{ channel "one" DFR_equalizer {{ framerate 1000 mural_minimum {2} }} outputframe {{ }} }}
    inputframe {{ name "frame.one" }} }} }} }}
)";
constexpr int kSettled = 40;  // frames until the zoom is constant
constexpr int kCompared = 20; // frames after these
constexpr int kDetected = 2;  // frames until the first repetition is known

struct Drawn {
    std::vector<OwnedPicture> pictures;
    double cpuSecondsPerFrame = 0; // of the node, over all frames
};

class Resolutions {
public:
    Resolutions(const AccuracyRuns& runs, bool quick)
        : runs_(runs), width_(quick ? 509 : 1021), height_(quick ? 383 : 767) {}

    void measureMoving(const std::string& scene, double zoom, std::vector<AccuracyRow>& rows) const {
        const auto wanted = native(scene, {"--first", std::to_string(kSettled), "--frames", std::to_string(kCompared)});
        const auto got = wanted ? wall(scene, zoom, kSettled, {"--frames", std::to_string(kSettled + kCompared)})
                                : Result<Drawn>(wanted.error());
        AccuracyRow row =
            rowOf(fmt::format("zoom {:.2g}, moving: {}", zoom, scene), zoom == 1 ? Bound::exact() : Bound{});
        compare(wanted, got, row);
        if (got) row.cost = Cost{1e9 * got.value().cpuSecondsPerFrame / (width_ * height_), 4};
        rows.push_back(std::move(row));
    }

    void measureStill(const std::string& scene, double zoom, std::vector<AccuracyRow>& rows) const {
        const std::string still = std::to_string(kSettled);
        const auto wanted = native(scene, {"--first", still, "--still", still, "--frames", "3"});
        const int first = kSettled + kDetected;
        const auto got = wanted ? wall(scene, zoom, first, {"--still", still, "--frames", std::to_string(first + 3)})
                                : Result<Drawn>(wanted.error());
        AccuracyRow row = rowOf(fmt::format("zoom {:.2g}, still: {}", zoom, scene), Bound::exact());
        compare(wanted, got, row);
        rows.push_back(std::move(row));
    }

private:
    static AccuracyRow rowOf(const std::string& what, const Bound& bound) {
        return {"Dynamic frame resolution", what, "native", {}, bound, {}, {}};
    }

    static void compare(const Result<std::vector<OwnedPicture>>& wanted, const Result<Drawn>& got, AccuracyRow& row) {
        if (!got) {
            row.failure = got.error().message;
        } else if (got.value().pictures.size() != wanted.value().size()) {
            row.failure =
                fmt::format("{} pictures received, {} expected", got.value().pictures.size(), wanted.value().size());
        } else {
            for (size_t p = 0; p < wanted.value().size(); ++p)
                row.error.add(errorOf(wanted.value()[p].view(), got.value().pictures[p].view()));
        }
    }

    [[nodiscard]] Words program(const std::string& scene, const Words& more) const {
        auto path = AccuracyRuns::scenesProgram();
        Words words{path ? *path : "mural-scenes", "--size", fmt::format("{}x{}", width_, height_), "--scene", scene};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    [[nodiscard]] Result<std::vector<OwnedPicture>> native(const std::string& scene, Words more) const {
        auto folder = ScratchFolder::make();
        if (!folder) return folder.error();
        more.insert(more.end(), {"--save", folder->path()});
        if (auto output = runs_.native(program(scene, more)); !output) return output.error();
        return readPictures(folder->path());
    }

    // first: the first saved frame, from 0.
    [[nodiscard]] Result<Drawn> wall(const std::string& scene, double zoom, int first, const Words& more) const {
        auto folder = ScratchFolder::make();
        if (!folder) return folder.error();
        const std::string config = folder->path() + "/dfr.eqc", report = folder->path() + "/report.json",
                          out = folder->path() + "/pictures";
        std::ofstream(config) << fmt::format(kConfig, width_, height_, zoom);
        std::string saved;
        for (int frame = first; frame < first + kCompared; ++frame) saved += fmt::format("{},", frame + 1);
        saved.pop_back();
        const Words options{"--config", config, "--out", out, "--save", saved, "--report", report};
        if (auto output = runs_.mural(options, program(scene, more)); !output) return output.error();
        auto pictures = readPictures(out);
        if (!pictures) return pictures.error();
        std::ifstream file(report);
        const auto json = nlohmann::json::parse(file, nullptr, false);
        if (!json.is_object() || !json.contains("nodes") || !json["nodes"].is_array())
            return Error{report + " contains no data about the nodes"};
        Drawn drawn{std::move(*pictures), 0};
        for (const auto& node : json["nodes"])
            drawn.cpuSecondsPerFrame += node.value("replaySeconds", 0.0) + node.value("readbackSeconds", 0.0);
        drawn.cpuSecondsPerFrame /= static_cast<double>(std::max<int64_t>(1, json.value("frames", int64_t{1})));
        return drawn;
    }

    const AccuracyRuns& runs_;
    const int width_, height_;
};

} // namespace

void measureResolutions(const AccuracyRuns& runs, bool quick, std::vector<AccuracyRow>& rows) {
    const Resolutions resolutions(runs, quick);
    const std::vector<double> zooms = quick ? std::vector{.5} : std::vector{1., .84, .71, .5, .35};
    const std::vector<std::string> scenes = quick ? Words{"lighting"} : Words{"lighting", "textures", "lines"};
    for (const double zoom : zooms) {
        reportProgress(fmt::format("dynamic frame resolution, zoom {:.2g}", zoom));
        for (const std::string& scene : scenes) {
            if (Interruption::signal() != 0) return;
            resolutions.measureMoving(scene, zoom, rows);
            if (zoom < 1) resolutions.measureStill(scene, zoom, rows);
        }
    }
}

} // namespace mural::cli
