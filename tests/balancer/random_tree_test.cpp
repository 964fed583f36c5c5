// Random trees of all decompositions in each other, carried out without drawing: every pixel is drawn for itself, all of
// its range and every sample once, in every frame; and nothing stands still.
#include <random>

#include <gtest/gtest.h>

#include "balancer/compound/even_split.hpp"
#include "balancer/compound/load_config.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/config/text/writer.hpp"
#include "tests/balancer/symbolic_wall.hpp"

namespace mural::compound {

namespace {

using config::Compound;
using config::ConfigFile;

class TreeMaker {
public:
    explicit TreeMaker(uint64_t seed) : random_(seed) {}

    ConfigFile make() {
        file_.version = config::kCurrentVersion;
        config::Observer observer;
        file_.config.observers.push_back(observer);
        config::View view;
        view.observer = 0u;
        config::Layout layout;
        layout.views.push_back(view);
        file_.config.layouts.push_back(layout);
        config::Segment segment;
        segment.channel = newChannel();
        config::Canvas canvas;
        canvas.layouts.emplace_back(0u);
        canvas.segments.push_back(segment);
        file_.config.canvases.push_back(canvas);
        Compound root;
        root.channel = config::ChannelPath{};
        root.buffers = config::BufferSet{config::Buffer::Color, config::Buffer::Depth};
        divide(root, 0);
        file_.config.compounds.push_back(root);
        return file_;
    }

private:
    enum class Kind { Areas, Ranges, Pixels, Samples, Frames };

    int number(int from, int to) { return std::uniform_int_distribution<>(from, to)(random_); }

    std::string newChannel() {
        config::Channel channel;
        channel.name = "c" + std::to_string(channels_++);
        config::Window window;
        window.viewport = Viewport{0, 0, double(number(9, 31)), double(number(9, 31))};
        window.channels.push_back(channel);
        config::Pipe pipe;
        pipe.windows.push_back(window);
        if (!file_.config.appNode || number(0, 1) == 0) {
            if (!file_.config.appNode) file_.config.appNode.emplace();
            file_.config.appNode->pipes.push_back(pipe);
        } else {
            file_.config.appNode->pipes.back().windows.push_back(window); // several channels on one pipe
        }
        return *channel.name;
    }

    // Cuts at random thousandths, from 0 to 1.
    std::vector<double> cuts(int n) {
        std::vector<double> all{0, 1};
        for (int i = 1; i < n; ++i) all.push_back(number(1, 999) / 1000.);
        std::sort(all.begin(), all.end());
        return all;
    }

    void divide(Compound& c, int depth) {
        if (depth > 2 || (depth > 0 && number(0, 2) == 0)) return;
        Kind kind = static_cast<Kind>(number(0, 4));
        if (kind == Kind::Frames && inFrames_) kind = Kind::Areas;
        const int n = number(2, 4);
        const auto edges = cuts(n);
        const bool columns = number(0, 1) == 0;
        const int shared = frames_++; // of all frame numbers' pictures
        for (int i = 0; i < n; ++i) {
            Compound child;
            const double from = edges[static_cast<size_t>(i)], to = edges[static_cast<size_t>(i) + 1];
            if (kind == Kind::Areas) child.viewport = columns ? Viewport{from, 0, to - from, 1} : Viewport{0, from, 1, to - from};
            if (kind == Kind::Ranges) child.range = Range{from, to};
            if (kind == Kind::Pixels) child.pixel = columns ? PixelKernel{i, 0, n, 1} : PixelKernel{0, i, 1, n};
            if (kind == Kind::Samples) child.subPixel = SubPixel{i, n};
            if (kind == Kind::Frames) {
                child.period = static_cast<uint32_t>(n);
                child.phase = static_cast<uint32_t>(i);
            }
            // The first share of areas and ranges may be drawn where it is shown.
            const bool here = i == 0 && (kind == Kind::Areas || kind == Kind::Ranges) && number(0, 1) == 0;
            if (!here) {
                child.channel = newChannel();
                config::Frame frame;
                frame.name = "f" + std::to_string(kind == Kind::Frames ? shared : frames_++);
                child.outputFrames.push_back(frame);
                if (kind != Kind::Frames || i == 0) c.inputFrames.push_back(frame);
            }
            const bool before = inFrames_;
            inFrames_ = inFrames_ || kind == Kind::Frames;
            divide(child, depth + 1);
            inFrames_ = before;
            c.children.push_back(std::move(child));
        }
    }

    std::mt19937_64 random_;
    ConfigFile file_;
    int channels_ = 0;
    int frames_ = 0;
    bool inFrames_ = false;
};

} // namespace

TEST(RandomTrees, showEveryPixelOnce) {
    size_t tasks = 0;
    for (uint64_t seed = 1; seed <= 150; ++seed) {
        const ConfigFile file = TreeMaker(seed).make();
        const LoadedConfig loaded = loadConfig(file, "seed " + std::to_string(seed), [](const std::string&) { return std::nullopt; });
        ASSERT_TRUE(loaded.ok()) << loaded.diagnostics.firstError() << config::writeConfig(file);
        FrameInput input = firstFrame(loaded.resolved);
        for (input.frameNumber = 0; input.frameNumber < 12; input.frameNumber += 1 + input.frameNumber / 4) {
            const FramePlan plan = planFrame(loaded.resolved, input);
            for (const ChannelPlan& c : plan.channels) tasks += c.tasks.size();
            ASSERT_EQ(testing::SymbolicWall(loaded.resolved, input, plan).run(), "") << "seed " << seed << " frame " << input.frameNumber << "\n" << config::writeConfig(file);
        }
    }
    EXPECT_GT(tasks, 4'000u);
}

} // namespace mural::compound
