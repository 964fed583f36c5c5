#include "tools/mural/accuracy/scene_rows.hpp"

#include <fmt/format.h>

#include "common/geometry/jitter.hpp"
#include "tools/mural/accuracy/progress.hpp"
#include "tools/mural/accuracy/scenes/scene_names.hpp"

namespace mural::cli {

namespace {

constexpr int kRounds = 2; // repetitions of all scenes: sort-last nodes use costs of the previous frame
// Per window, and after frames with readback or unknown mipmap selection: nodes draw all pixels of these frames.
constexpr size_t kWholeFrames = 2;
constexpr double kEye = 0.3, kFocus = 6;

// Bounds per scene, in the order of kSceneNames: triangles, lighting, textures, lines, blending, depths.
using Bounds = std::vector<Bound>;

const Bound kNotPromised{};

} // namespace

struct SceneRows::Method {
    enum class Reference { Native, LeftEye, RightEye, BothEyes, Mean, TwiceAsLarge };

    std::string name;
    Words options; // of mural run
    Bounds bounds; // a single bound: all scenes together
    Reference reference = Reference::Native;
    int samples = 1;
    bool quick = false; // also measured with --quick
    // nodes draw other pixels than shown: scenes are measured separately, without their first frames (kWholeFrames)
    bool otherPixels = false;
};

// Bounds are exact for exact methods; docs/measurements/accuracy.md gives reasons for the others.
std::vector<SceneRows::Method> SceneRows::methods() {
    using R = Method::Reference;
    const Bounds exact{Bound::exact()};
    const Words eyes{"--eye-base", fmt::format("{}", 2 * kEye), "--focus", fmt::format("{}", kFocus)};
    const auto eye = [&](const std::string& mode, const Words& more = {}) {
        Words options{"--stereo", mode};
        options.insert(options.end(), eyes.begin(), eyes.end());
        options.insert(options.end(), more.begin(), more.end());
        return options;
    };
    const Bound moved{0.005, {}, 50.0};
    const Bounds movedScenes{moved, moved, {{}, {}, 45.0}, {{}, {}, 40.0}, moved, kNotPromised};
    const Bound mean{0.001, {}, 60.0};
    const Bounds meanScenes{mean, mean, mean, mean, mean, kNotPromised};
    const Bound kernelOfPolygons{{}, {}, 40.0};
    const Bounds kernels{kernelOfPolygons, kernelOfPolygons, Bound::exact(),
                         kNotPromised,     kernelOfPolygons, kNotPromised};
    const Bounds exactScenes(scenes::kSceneNames.size(), Bound::exact());
    const Bounds notPromised(scenes::kSceneNames.size(), kNotPromised);
    const Bound lean{0.0025, {}, 50.0};
    return {
        {"2D, 2x2 tiles", {"--tiles", "2x2"}, exact, R::Native, 1, true},
        {"2D, 3x1 tiles of unequal size", {"--tiles", "3x1"}, exact},
        {"2D, 7x5 unequal tiles on 4 nodes", {"--tiles", "7x5", "--local-nodes", "4"}, exact},
        {"2D, tiling culled, 3x2", {"--tiles", "3x2", "--tiling", "culled"}, exact, R::Native, 1, true},
        {"DB, 2 ranges", {"--db", "2"}, exact},
        {"DB, 3 ranges", {"--db", "3"}, exact, R::Native, 1, true},
        {"DPlex, 3 phases", {"--dplex", "3"}, exact, R::Native, 1, true},
        {"mixed: 2x1 tiles of 2 ranges",
         {"--tiles", "2x1", "--db", "2", "--local-nodes", "4"},
         exact,
         R::Native,
         1,
         true},
        {"mixed: 2 phases of 1x2 tiles", {"--dplex", "2", "--tiles", "1x2", "--local-nodes", "4"}, exact},
        {"2D, tiling lean, 2x2",
         {"--tiles", "2x2", "--tiling", "lean"},
         {lean, lean, {{}, {}, 45.0}, lean, lean, kNotPromised},
         R::Native,
         1,
         true},
        {"stereo, left eye", eye("left"), movedScenes, R::LeftEye, 1, true},
        {"stereo, right eye of 2x1 tiles", eye("right", {"--tiles", "2x1", "--local-nodes", "2"}), movedScenes,
         R::RightEye},
        {"stereo, anaglyph", eye("anaglyph"), movedScenes, R::BothEyes},
        {"subpixel, 2 samples", {"--subpixel", "2"}, meanScenes, R::Mean, 2, true},
        {"subpixel, 4 samples", {"--subpixel", "4"}, meanScenes, R::Mean, 4},
        {"mixed: 2x1 tiles of 2 samples",
         {"--subpixel", "2", "--tiles", "2x1", "--local-nodes", "4"},
         meanScenes,
         R::Mean,
         2},
        {"pixel, kernel of 2x1", {"--pixel", "2x1"}, kernels, R::Native, 1, false, true},
        {"pixel, kernel of 2x2", {"--pixel", "2x2"}, kernels, R::Native, 1, true, true},
        {"pixel, kernel of 3x1", {"--pixel", "3"}, kernels, R::Native, 1, false, true},
        {"zoom of 2", {"--zoom", "2"}, exactScenes, R::TwiceAsLarge, 1, true, true},
        {"zoom of 0.75", {"--zoom", "0.75"}, notPromised, R::Native, 1, false, true},
        {"zoom of 0.5", {"--zoom", "0.5"}, notPromised, R::Native, 1, true, true},
    };
}

Words SceneRows::program(const Words& more) const {
    auto path = AccuracyRuns::scenesProgram();
    Words words{path ? *path : "mural-scenes", "--size", fmt::format("{}x{}", width(), height()), "--frames",
                std::to_string(kRounds * scenes::kSceneNames.size())};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::string SceneRows::subject() const {
    const OwnedPicture& first = native_.front();
    return fmt::format("{} scenes of mural-scenes, {} frames of {}x{} pixels", scenes::kSceneNames.size(),
                       native_.size(), first.width(), first.height());
}

Result<std::vector<OwnedPicture>> SceneRows::drawNatively(const Words& more) {
    auto folder = ScratchFolder::make();
    if (!folder) return folder.error();
    Words arguments{"--save", folder->path()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto output = runs_.native(program(arguments));
    if (!output) return output.error();
    gl_ = output->substr(0, output->find('\n'));
    return readPictures(folder->path());
}

Result<std::vector<OwnedPicture>> SceneRows::drawByMural(const Words& options, const Words& more) {
    auto folder = ScratchFolder::make();
    if (!folder) return folder.error();
    Words all = options;
    all.insert(all.end(), {"--out", folder->path()});
    if (auto output = runs_.mural(all, program(more)); !output) return output.error();
    return readPictures(folder->path());
}

Result<void> SceneRows::prepare() {
    if (auto path = AccuracyRuns::scenesProgram(); !path) return path.error();
    auto drawn = drawNatively({});
    if (!drawn) return drawn.error();
    native_ = std::move(*drawn);
    if (native_.size() != kRounds * scenes::kSceneNames.size())
        return Error{"mural-scenes did not draw all scenes; run it alone to see the error"};
    return {};
}

// Mean of one picture per sample, with moved viewports; rounds to nearest, halves up, as `mural run`.
Result<std::vector<OwnedPicture>> SceneRows::meanOf(int samples) {
    std::vector<std::vector<unsigned>> sums;
    std::vector<OwnedPicture> mean;
    for (int i = 0; i < samples; ++i) {
        const Jitter jitter = jitterOf({i, samples});
        auto drawn = drawNatively({"--move", fmt::format("{:.17g},{:.17g}", -jitter.x, -jitter.y)});
        if (!drawn) return drawn.error();
        if (mean.empty())
            mean = std::move(*drawn);
        else if (drawn->size() != mean.size())
            return Error{"mural-scenes did not draw all scenes"};
        sums.resize(mean.size());
        for (size_t p = 0; p < mean.size(); ++p) {
            const Picture from = i == 0 ? mean[p].view() : (*drawn)[p].view();
            sums[p].resize(from.sizeBytes());
            for (size_t b = 0; b < sums[p].size(); ++b) sums[p][b] += std::to_integer<unsigned>(from.bgra[b]);
        }
    }
    const auto n = static_cast<unsigned>(samples);
    for (size_t p = 0; p < mean.size(); ++p)
        for (size_t b = 0; b < sums[p].size(); ++b)
            mean[p].data()[b] = static_cast<std::byte>((2 * sums[p][b] + n) / (2 * n));
    return mean;
}

// A window of twice the size; each pixel is the mean of four.
Result<std::vector<OwnedPicture>> SceneRows::reduced(const Words& more) {
    Words words{"--size", fmt::format("{}x{}", 2 * width(), 2 * height())};
    words.insert(words.end(), more.begin(), more.end());
    auto large = drawNatively(words);
    if (!large) return large.error();
    constexpr size_t kPixel = kPictureBytesPerPixel;
    std::vector<OwnedPicture> small;
    for (OwnedPicture& from : *large) {
        OwnedPicture& to = small.emplace_back(width(), height());
        for (int y = 0; y < height(); ++y)
            for (size_t b = 0; b < to.rowBytes(); ++b) {
                const size_t at = b / kPixel * 2 * kPixel + b % kPixel;
                const std::byte *upper = from.row(2 * y) + at, *lower = from.row(2 * y + 1) + at;
                const unsigned sum = std::to_integer<unsigned>(upper[0]) + std::to_integer<unsigned>(upper[kPixel]) +
                                     std::to_integer<unsigned>(lower[0]) + std::to_integer<unsigned>(lower[kPixel]);
                to.row(y)[b] = static_cast<std::byte>((sum + 2) / 4);
            }
    }
    return small;
}

Result<std::vector<OwnedPicture>> SceneRows::anaglyph() {
    auto left = drawNatively({"--eye", fmt::format("{},{}", -kEye, kFocus)}),
         right = drawNatively({"--eye", fmt::format("{},{}", kEye, kFocus)});
    if (!left) return left.error();
    if (!right) return right.error();
    if (left->size() != right->size()) return Error{"mural-scenes did not draw all scenes"};
    for (size_t p = 0; p < right->size(); ++p)
        // red
        for (size_t b = 2; b < (*right)[p].view().sizeBytes(); b += 4) (*right)[p].data()[b] = (*left)[p].data()[b];
    return right;
}

Result<std::vector<OwnedPicture>> SceneRows::referenceOf(const Method& method) {
    using R = Method::Reference;
    switch (method.reference) {
    case R::LeftEye: return drawNatively({"--eye", fmt::format("{},{}", -kEye, kFocus)});
    case R::RightEye: return drawNatively({"--eye", fmt::format("{},{}", kEye, kFocus)});
    case R::BothEyes: return anaglyph();
    case R::Mean: return meanOf(method.samples);
    case R::TwiceAsLarge: return reduced({});
    case R::Native: break;
    }
    std::vector<OwnedPicture> copies;
    for (const OwnedPicture& p : native_) copies.emplace_back(p.view());
    return copies;
}

void SceneRows::measure(std::vector<AccuracyRow>& rows) {
    for (const Method& method : methods()) {
        if (quick_ && !method.quick) continue;
        reportProgress(method.name);
        if (method.otherPixels)
            measureEachScene(method, rows);
        else
            measureAllScenes(method, rows);
    }
}

AccuracyRow SceneRows::rowOf(const Method& method, size_t scene) {
    using R = Method::Reference;
    const bool exact = method.bounds.size() == 1;
    AccuracyRow row;
    row.group = exact ? "Exact decompositions" : "Decompositions with other rounding, and approximate ones";
    row.reference = method.reference == R::Native         ? "native"
                    : method.reference == R::Mean         ? fmt::format("mean of {} native", method.samples)
                    : method.reference == R::BothEyes     ? "two native eyes"
                    : method.reference == R::TwiceAsLarge ? "native at twice the size, reduced"
                                                          : "native eye";
    row.what = exact ? method.name : method.name + ": " + scenes::kSceneNames[scene];
    row.bound = method.bounds[scene];
    return row;
}

void SceneRows::measureAllScenes(const Method& method, std::vector<AccuracyRow>& rows) {
    const bool exact = method.bounds.size() == 1;
    const size_t step = exact ? 1 : scenes::kSceneNames.size();
    auto wanted = referenceOf(method);
    auto got = wanted ? drawByMural(method.options, {}) : Result<std::vector<OwnedPicture>>(wanted.error());
    if (!got || got->size() != wanted->size()) {
        AccuracyRow row = rowOf(method, 0);
        row.what = method.name;
        row.failure =
            got ? fmt::format("{} pictures received, {} expected", got->size(), wanted->size()) : got.error().message;
        rows.push_back(row);
        return;
    }
    for (size_t scene = 0; scene < method.bounds.size(); ++scene) {
        AccuracyRow row = rowOf(method, scene);
        for (size_t p = exact ? 0 : scene; p < got->size(); p += step)
            row.error.add(errorOf((*wanted)[p].view(), (*got)[p].view()));
        rows.push_back(row);
    }
}

void SceneRows::measureEachScene(const Method& method, std::vector<AccuracyRow>& rows) {
    for (size_t scene = 0; scene < method.bounds.size(); ++scene) {
        const Words alone{"--scene", scenes::kSceneNames[scene], "--frames", std::to_string(2 * kWholeFrames)};
        AccuracyRow row = rowOf(method, scene);
        auto wanted = method.reference == Method::Reference::TwiceAsLarge ? reduced(alone) : drawNatively(alone);
        auto got = wanted ? drawByMural(method.options, alone) : Result<std::vector<OwnedPicture>>(wanted.error());
        if (!got)
            row.failure = got.error().message;
        else if (got->size() != wanted->size())
            row.failure = fmt::format("{} pictures received, {} expected", got->size(), wanted->size());
        for (size_t p = kWholeFrames; row.failure.empty() && p < got->size(); ++p)
            row.error.add(errorOf((*wanted)[p].view(), (*got)[p].view()));
        rows.push_back(row);
    }
}

} // namespace mural::cli
