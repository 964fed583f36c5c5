#include "balancer/simulation/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>

namespace mural::simulation {

namespace {

constexpr size_t kSceneColumns = 96, kSceneRows = 54, kSceneRanges = 512;
constexpr int kStepFrame = 40;
constexpr double kGround = .08;    // cost of a cell without a blob, relative to the middle of a blob
constexpr double kBlobWidth = .11; // standard deviation of a blob, relative to the picture's height

struct Blob {
    double x, y;
    double height = 1;
    double width = kBlobWidth;
};

struct Picture {
    std::vector<Blob> blobs;
    double ground = kGround;
    double lowest = 0; // cost below 30 % of the height
    double box = 0;    // cost of the upper right corner, 25 % of each side
    double total = 1;  // cost of the frame
};

// Each scene describes its frames.
using Course = std::function<Picture(size_t)>;

double square(double value) { return value * value; }

float cellCost(const Picture& p, double x, double y) {
    double cost = p.ground;
    for (const Blob& b : p.blobs)
        cost += b.height * std::exp(-(square((x - b.x) * 16 / 9) + square(y - b.y)) / (2 * square(b.width)));
    if (y < .3) cost += p.lowest;
    if (x > .75 && y > .75) cost += p.box;
    return static_cast<float>(cost);
}

float rangeCost(const Picture& p, double at) {
    double cost = p.ground * 2;
    for (const Blob& b : p.blobs)
        cost += b.height * std::exp(-square(at - (b.x + b.y) / 2) / (2 * square(b.width / 2)));
    if (at < .3) cost += p.lowest;
    if (at > .9) cost += p.box;
    return static_cast<float>(cost);
}

void normalize(std::vector<float>& values, double total) {
    double sum = 0;
    for (const float v : values) sum += v;
    for (float& v : values) v = static_cast<float>(v * total / sum);
}

CostFrame frameOf(const Picture& picture) {
    CostFrame frame;
    for (size_t row = 0; row < kSceneRows; ++row)
        for (size_t column = 0; column < kSceneColumns; ++column)
            frame.cells.push_back(cellCost(picture, (static_cast<double>(column) + .5) / kSceneColumns,
                                           (static_cast<double>(row) + .5) / kSceneRows));
    for (size_t i = 0; i < kSceneRanges; ++i)
        frame.ranges.push_back(rangeCost(picture, (static_cast<double>(i) + .5) / kSceneRanges));
    normalize(frame.cells, picture.total);
    normalize(frame.ranges, picture.total);
    return frame;
}

Course movingBlob(uint32_t seed) {
    const double start = seed % 628 / 100.;
    return [start](size_t f) {
        const double angle = start + 2 * std::numbers::pi * static_cast<double>(f) / 60;
        return Picture{{{.5 + .35 * std::cos(angle), .5 + .35 * std::sin(angle)}}};
    };
}

Course jumpCuts(uint32_t seed) {
    return [seed](size_t f) {
        std::mt19937 random(seed * 977 + static_cast<uint32_t>(f / 33)); // a new camera every 33 frames
        std::uniform_real_distribution<> place(.08, .92);
        const double x = place(random), y = place(random);
        return Picture{{{x, y}}};
    };
}

Course step(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<> place(.1, .4);
    const double x = place(random), y = place(random);
    return [x, y](size_t f) {
        Picture p{{{x, y}}};
        if (f >= kStepFrame) {
            p.blobs.push_back({1 - y, 1 - x, 2});
            p.total = 2;
        }
        return p;
    };
}

Course randomWalk(uint32_t seed, size_t frames) {
    std::mt19937 random(seed);
    std::normal_distribution<> move(0, .02);
    std::vector<Blob> path{{.5, .5}};
    const auto mirrored = [](double v) { return v < 0 ? -v : v > 1 ? 2 - v : v; };
    while (path.size() < frames)
        path.push_back({mirrored(path.back().x + move(random)), mirrored(path.back().y + move(random))});
    return [path](size_t f) { return Picture{{path[f]}}; };
}

Course severalBlobs(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<> any(0, 1);
    struct Way {
        double x, y, dx, dy, height, width;
    };
    std::vector<Way> ways;
    for (int i = 0; i < 5; ++i) {
        const double x = any(random), y = any(random), dx = any(random), dy = any(random);
        ways.push_back({x, y, (dx - .5) / 50, (dy - .5) / 50, .3 + any(random), .04 + .08 * any(random)});
    }
    const auto mirrored = [](double v) {
        const double turn = std::fmod(std::abs(v), 2);
        return turn > 1 ? 2 - turn : turn;
    };
    return [ways, mirrored](size_t f) {
        Picture p;
        const auto t = static_cast<double>(f);
        for (const Way& w : ways)
            p.blobs.push_back({mirrored(w.x + w.dx * t), mirrored(w.y + w.dy * t), w.height, w.width});
        return p;
    };
}

Course courseOf(const std::string& name, size_t frames, uint32_t seed) {
    if (name == "moving") return movingBlob(seed);
    if (name == "jump") return jumpCuts(seed);
    if (name == "step") return step(seed);
    if (name == "walk") return randomWalk(seed, frames);
    if (name == "several") return severalBlobs(seed);
    Picture still{{{.5, .5}}};
    if (name == "corner") still = {{{.1, .1}}};
    if (name == "lower") still = {{}, kGround, 1};
    if (name == "constant") still = {{}, 1};
    if (name == "volume") still = {{}, kGround, 0, 1};
    return [still](size_t) { return still; };
}

} // namespace

const std::vector<Scene>& scenes() {
    static const std::vector<Scene> kScenes = {
        {"centre", "a blob in the centre", true, 0},
        {"corner", "a blob in the lower left corner", true, 0},
        {"lower", "the lower 30 % are dear", true, 0},
        {"volume", "a dear box in the upper right corner", true, 0},
        {"constant", "all parts cost the same", true, 0},
        {"moving", "a blob circles in 60 frames", false, 0},
        {"walk", "a blob walks at random", false, 0},
        {"several", "five blobs move at different speeds", false, 0},
        {"jump", "a blob jumps every 33 frames", false, 0},
        {"step", "a second blob appears in frame 40", false, kStepFrame},
    };
    return kScenes;
}

const Scene* findScene(const std::string& name) {
    for (const Scene& s : scenes())
        if (name == s.name) return &s;
    return nullptr;
}

CostTrace makeScene(const Scene& scene, size_t frames, uint32_t seed) {
    CostTrace trace{scene.name, kSceneColumns, kSceneRows, kSceneRanges, {}};
    const Course course = courseOf(scene.name, frames, seed);
    for (size_t f = 0; f < frames; ++f) {
        if (f > 0 && scene.isConstant)
            trace.frames.push_back(trace.frames.front());
        else
            trace.frames.push_back(frameOf(course(f)));
    }
    return trace;
}

} // namespace mural::simulation
