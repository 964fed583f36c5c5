// Random compound trees with nested decompositions.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "balancer/config/config.hpp"

namespace mural::compound::testing {

using config::Compound;
using config::ConfigFile;

class TreeMaker {
public:
    // steered: frames export random parts, and inputs may write to random parts.
    explicit TreeMaker(uint64_t seed, bool steered = false) : random_(seed), steered_(steered) {}

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
    enum class Kind { ViewportAssignment, Ranges, Pixels, Samples, Frames };

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

    // Random cuts in thousandths, from 0 to 1.
    std::vector<double> cuts(int n) {
        std::vector<double> all{0, 1};
        for (int i = 1; i < n; ++i) all.push_back(number(1, 999) / 1000.);
        std::sort(all.begin(), all.end());
        return all;
    }

    Viewport anyPart() {
        const auto x = cuts(3), y = cuts(3);
        return {x[1], y[1], x[2] - x[1], y[2] - y[1]};
    }

    void divide(Compound& c, int depth) {
        if (depth > 2 || (depth > 0 && number(0, 2) == 0)) return;
        Kind kind = static_cast<Kind>(number(0, 4));
        if (kind == Kind::Frames && inFrames_) kind = Kind::ViewportAssignment;
        const int n = number(2, 4);
        const auto edges = cuts(n);
        const bool columns = number(0, 1) == 0;
        const int shared = frames_++; // one name for the pictures of all phases
        for (int i = 0; i < n; ++i) {
            Compound child;
            const double from = edges[static_cast<size_t>(i)], to = edges[static_cast<size_t>(i) + 1];
            if (kind == Kind::ViewportAssignment)
                child.viewport = columns ? Viewport{from, 0, to - from, 1} : Viewport{0, from, 1, to - from};
            if (kind == Kind::Ranges) child.range = Range{from, to};
            if (kind == Kind::Pixels) child.pixel = columns ? PixelKernel{i, 0, n, 1} : PixelKernel{0, i, 1, n};
            if (kind == Kind::Samples) child.subPixel = SubPixel{i, n};
            if (kind == Kind::Frames) {
                child.period = static_cast<uint32_t>(n);
                child.phase = static_cast<uint32_t>(i);
            }
            // The first part of areas and ranges may be drawn at the destination.
            const bool here = i == 0 && (kind == Kind::ViewportAssignment || kind == Kind::Ranges) && number(0, 1) == 0;
            if (!here) {
                child.channel = newChannel();
                config::Frame frame;
                frame.name = "f" + std::to_string(kind == Kind::Frames ? shared : frames_++);
                config::Frame taken = frame;
                if (steered_) {
                    if (number(0, 1) == 0) frame.viewport = anyPart();
                    if (number(0, 2) == 0) taken.viewport = anyPart();
                    if (number(0, 1) == 0) frame.buffers = config::BufferSet{config::Buffer::Color};
                }
                child.outputFrames.push_back(frame);
                if (kind != Kind::Frames || i == 0) c.inputFrames.push_back(taken);
            }
            const bool before = inFrames_;
            inFrames_ = inFrames_ || kind == Kind::Frames;
            divide(child, depth + 1);
            inFrames_ = before;
            c.children.push_back(std::move(child));
        }
    }

    std::mt19937_64 random_;
    const bool steered_;
    ConfigFile file_;
    int channels_ = 0;
    int frames_ = 0;
    bool inFrames_ = false;
};

} // namespace mural::compound::testing
