// The configuration that simulations divide: one view, one channel per node, and a load equalizer.
#include "balancer/simulation/simulator.hpp"

namespace mural::simulation {

namespace {

constexpr double kWidth = 1920, kHeight = 1080;

config::Pipe pipeWith(const std::string& channel, bool isShown) {
    config::Channel c;
    c.name = channel;
    config::Window window;
    window.name = channel;
    window.viewport = Viewport{0, 0, kWidth, kHeight};
    window.channels.push_back(c);
    if (!isShown) window.attributes.hintDrawable = config::value::kFbo;
    config::Pipe pipe;
    pipe.windows.push_back(window);
    return pipe;
}

config::Canvas wall() {
    config::Canvas canvas;
    canvas.name = "wall";
    canvas.layouts.emplace_back(std::string("whole"));
    canvas.surface = config::Wall{{-.8, -.45, -1}, {.8, -.45, -1}, {-.8, .45, -1}, config::WallType::Fixed, {}};
    config::Segment segment;
    segment.name = segment.channel = "node0";
    canvas.segments.push_back(segment);
    return canvas;
}

} // namespace

compound::LoadedConfig dividedConfig(size_t nodes, config::SplitMode mode) {
    config::ConfigFile file;
    file.version = config::kCurrentVersion;
    file.config.observers.emplace_back();
    config::View view;
    view.observer = 0u;
    config::Layout layout;
    layout.name = "whole";
    layout.views.push_back(view);
    file.config.layouts.push_back(layout);
    file.config.canvases.push_back(wall());
    config::Compound root;
    root.channel = config::ChannelPath{
        {{config::PathStep::Segment, std::string("node0")}, {config::PathStep::Layout, std::string("whole")}}};
    if (mode == config::SplitMode::Db) root.buffers = config::BufferSet{config::Buffer::Color, config::Buffer::Depth};
    config::LoadEqualizer equalizer;
    equalizer.mode = mode;
    root.equalizers.emplace_back(equalizer);
    for (size_t i = 0; i < nodes; ++i) {
        const std::string name = "node" + std::to_string(i);
        config::Node node;
        node.name = name;
        node.host = name;
        node.pipes.push_back(pipeWith(name, i == 0));
        file.config.nodes.push_back(node);
        config::Compound part;
        if (i > 0) {
            config::Frame frame;
            frame.name = name;
            part.channel = name;
            part.outputFrames.push_back(frame);
            root.inputFrames.push_back(frame);
        }
        root.children.push_back(std::move(part));
    }
    file.config.compounds.push_back(std::move(root));
    return compound::loadConfig(std::move(file), "simulation", [](const std::string&) { return std::nullopt; });
}

} // namespace mural::simulation
