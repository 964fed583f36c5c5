#include "tools/mural/accuracy/recording_rows.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "streamcodec/trace/trace_reader.hpp"
#include "tools/mural/accuracy/composition_rows.hpp"
#include "tools/mural/accuracy/progress.hpp"

namespace mural::cli {

namespace {

constexpr size_t kFramesBeforeReads = 2; // per window; afterwards the reads of the program are determined
constexpr int kMaxSamples = 16;          // reference for antialiasing

struct RecordingMethod {
    std::string name;
    Words options;
    Bound bound;
    bool manySamples = false; // compared with the mean of kMaxSamples, not with one node's picture
    double pictures = 1;      // transferred for assembly
    bool quick = false;
    bool otherPixels = false; // nodes draw other pixels than shown, except in the first frames
};

std::vector<RecordingMethod> recordingMethods() {
    const Bound exact = Bound::exact(), notPromised{};
    std::vector<RecordingMethod> all{
        {"2D, 2x2 tiles", {"--tiles", "2x2"}, exact, false, 1, true},
        {"DB, 3 ranges", {"--db", "3"}, exact, false, 1, true},
        {"DPlex, 3 phases", {"--dplex", "3"}, exact, false, 1, false},
        {"shifted viewport: tiling lean, 2x2", {"--tiles", "2x2", "--tiling", "lean"}, notPromised, false, 1, true},
        {"pixel, kernel of 2x1", {"--pixel", "2x1"}, notPromised, false, 1, true, true},
        {"pixel, kernel of 2x2", {"--pixel", "2x2"}, notPromised, false, 1, false, true},
        {"zoom of 0.75", {"--zoom", "0.75"}, notPromised, false, 1, false, true},
        {"zoom of 0.5", {"--zoom", "0.5"}, notPromised, false, 1, true, true},
        {"one sample", {}, notPromised, true, 1, true},
        {"zoom of 2", {"--zoom", "2"}, notPromised, true, 1, false, true},
    };
    for (const int n : {2, 4, 8})
        all.push_back({fmt::format("{} samples", n),
                       {"--subpixel", std::to_string(n)},
                       notPromised,
                       true,
                       static_cast<double>(n),
                       n == 2});
    return all;
}

struct Replayed {
    std::vector<OwnedPicture> pictures;
    double cpuSeconds = 0; // of the replay threads
    int64_t frames = 0, exchangeBytes = 0;
};

Result<Replayed> replayed(const AccuracyRuns& runs, const std::string& recording, const Words& options) {
    auto folder = ScratchFolder::make();
    if (!folder) return folder.error();
    const std::string report = folder->path() + "/report.json", out = folder->path() + "/pictures";
    Words all = options;
    all.insert(all.end(), {"--out", out, "--report", report});
    if (auto output = runs.replay(all, recording); !output) return output.error();
    auto pictures = readPictures(out);
    if (!pictures) return pictures.error();
    if (pictures->empty()) return Error{recording + " contains no picture; record a program that draws"};
    Replayed r{std::move(*pictures), 0, 0, 0};
    std::ifstream file(report);
    const auto json = nlohmann::json::parse(file, nullptr, false);
    if (!json.is_object() || !json.contains("nodes") || !json["nodes"].is_array())
        return Error{report + " contains no data about the nodes"};
    r.frames = json.value("frames", int64_t{0});
    for (const auto& node : json["nodes"]) {
        r.cpuSeconds += node.value("replaySeconds", 0.0) + node.value("readbackSeconds", 0.0);
        r.exchangeBytes += node.value("exchangeBytes", int64_t{0});
    }
    return r;
}

} // namespace

Result<void> checkRecording(const std::string& recording) {
    auto reader = trace::TraceReader::open(recording);
    if (!reader) return reader.error();
    if (auto whole = reader.value()->verify(); !whole) return whole.error();
    if (reader.value()->frames() == 0)
        return Error{"trace " + recording +
                     " has no frame, because the program showed no picture; mural dump prints its calls"};
    if (!reader.value()->notice().empty()) reportProgress(reader.value()->notice());
    return {};
}

void measureRecording(const AccuracyRuns& runs, const std::string& recording, bool quick,
                      std::vector<AccuracyRow>& rows) {
    const std::string name = std::filesystem::path(recording).stem().string(), group = "Recording: " + name;
    const auto one = replayed(runs, recording, {});
    if (!one) { // without a reference: reported in one line
        rows.push_back({group, "one node", "", {}, {}, one.error().message, {}});
        return;
    }
    const auto many = replayed(runs, recording, {"--subpixel", std::to_string(kMaxSamples)});
    for (const RecordingMethod& method : recordingMethods()) {
        if (quick && !method.quick) continue;
        reportProgress(name + ": " + method.name);
        const Result<Replayed>& wanted = method.manySamples ? many : one;
        AccuracyRow row{group, method.name,  method.manySamples ? fmt::format("{} samples", kMaxSamples) : "one node",
                        {},    method.bound, {},
                        {}};
        const auto got = wanted ? replayed(runs, recording, method.options) : Result<Replayed>(wanted.error());
        if (!got)
            row.failure = got.error().message;
        else if (got.value().pictures.size() != wanted.value().pictures.size())
            row.failure = fmt::format("{} pictures received, {} expected", got.value().pictures.size(),
                                      wanted.value().pictures.size());
        else if (method.otherPixels && got.value().pictures.size() <= kFramesBeforeReads)
            row.failure = fmt::format("the first {} frames do not count, and there are no others; record more frames",
                                      kFramesBeforeReads);
        if (row.failure.empty()) {
            const Replayed &a = wanted.value(), &b = got.value();
            for (size_t p = method.otherPixels ? kFramesBeforeReads : 0; p < a.pictures.size(); ++p)
                row.error.add(errorOf(a.pictures[p].view(), b.pictures[p].view()));
            const double pixels = static_cast<double>(std::max<int64_t>(b.frames, 1)) * b.pictures.front().width() *
                                  b.pictures.front().height();
            row.cost = Cost{1e9 * b.cpuSeconds / pixels,
                            b.exchangeBytes > 0 ? static_cast<double>(b.exchangeBytes) / pixels : 4 * method.pictures};
        }
        rows.push_back(row);
    }
    measureCodecs(one.value().pictures, "Codecs, on the trace " + name, quick, rows);
}

} // namespace mural::cli
