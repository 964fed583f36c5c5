// Resolves nodes, pipes, windows and the channels of the file.
#include <cmath>

#include "balancer/config/resolving/attribute_filler.hpp"
#include "balancer/config/resolving/resolver.hpp"

namespace mural::config {

namespace {

// Areas with negative or zero size count as omitted, as in Equalizer.
Viewport screenAreaOf(Resolver& r, const std::optional<Viewport>& given, SourcePosition at, const char* of) {
    if (!given) return {};
    if (given->w > 0 && given->h > 0 && given->w <= 1e6 && given->h <= 1e6 && std::abs(given->x) <= 1e6 &&
        std::abs(given->y) <= 1e6)
        return *given;
    r.diagnostics.warn(at,
                       std::string("the viewport of this ") + of + " is empty or too large, the whole screen is used",
                       "set x, y, width and height in pixels, or as fractions of 1");
    return {};
}

std::vector<Connection> connectionsOf(Resolver& r, const std::vector<Connection>& given) {
    std::vector<Connection> all = given;
    for (Connection& c : all) {
        fillAttributes(c, "CONNECTION", r.defaults);
        if (c.port && *c.port > 65535)
            r.diagnostics.error(c.at, "port " + std::to_string(*c.port) + " is invalid",
                                "use a port up to 65535, or 0 for any");
    }
    return all;
}

void addChannels(Resolver& r, Index window, const std::vector<Channel>& channels) {
    for (const Channel& c : channels) {
        ResolvedChannel channel;
        channel.window = window;
        channel.name = c.name.value_or("");
        channel.viewport = screenAreaOf(r, c.viewport, c.at, "channel");
        channel.attributes = c.attributes;
        channel.at = c.at;
        fillAttributes(channel.attributes, "CHANNEL", r.defaults);
        r.out.windows[Resolver::at(window)].channels.push_back(Resolver::add(r.out.channels, channel));
    }
}

void addWindows(Resolver& r, Index pipe, const std::vector<Window>& windows) {
    for (const Window& w : windows) {
        ResolvedWindow window;
        window.pipe = pipe;
        window.name = w.name.value_or("");
        window.viewport = screenAreaOf(r, w.viewport, w.at, "window");
        window.attributes = w.attributes;
        window.at = w.at;
        fillAttributes(window.attributes, "WINDOW", r.defaults);
        const Index index = Resolver::add(r.out.windows, window);
        r.out.pipes[Resolver::at(pipe)].windows.push_back(index);
        addChannels(r, index, w.channels);
    }
}

void addPipes(Resolver& r, Index node, const std::vector<Pipe>& pipes) {
    for (const Pipe& p : pipes) {
        ResolvedPipe pipe;
        pipe.node = node;
        pipe.name = p.name.value_or("");
        pipe.port = p.port;
        pipe.device = p.device;
        pipe.attributes = p.attributes;
        pipe.at = p.at;
        if (p.viewport) {
            const Viewport v = screenAreaOf(r, p.viewport, p.at, "pipe");
            if (inPixels(v))
                pipe.viewport = PixelViewport{static_cast<int32_t>(v.x), static_cast<int32_t>(v.y),
                                              static_cast<int32_t>(v.w), static_cast<int32_t>(v.h)};
        }
        fillAttributes(pipe.attributes, "PIPE", r.defaults);
        const Index index = Resolver::add(r.out.pipes, pipe);
        r.out.nodes[Resolver::at(node)].pipes.push_back(index);
        addWindows(r, index, p.windows);
    }
}

void addNode(Resolver& r, const Node& n, bool isApplication) {
    ResolvedNode node;
    node.isApplication = isApplication;
    node.name = n.name.value_or("");
    node.host = n.host.value_or("");
    node.connections = connectionsOf(r, n.connections);
    node.attributes = n.attributes;
    node.at = n.at;
    fillAttributes(node.attributes, "NODE", r.defaults);
    if (!node.attributes.threadModel) node.attributes.threadModel = value::kDrawSync;
    addPipes(r, Resolver::add(r.out.nodes, node), n.pipes);
}

} // namespace

void resolveResources(Resolver& r) {
    const Config& config = r.file.config;
    r.out.name = config.name.value_or("");
    r.out.latency = config.latency.value_or(1);
    ConfigAttributes attributes = config.attributes;
    fillAttributes(attributes, "CONFIG", r.defaults);
    r.out.eyeBase = attributes.eyeBase.value_or(.05);
    r.out.robustness = attributes.robustness.value_or(value::kAuto);
    r.out.serverConnections = r.file.serverConnections; // defaults of nodes do not apply to the server
    for (Connection& c : r.out.serverConnections) {
        if (!c.type) c.type = r.defaults.get<ConnectionType>("EQ_CONNECTION_IATTR_TYPE");
    }
    addNode(r, config.appNode.value_or(Node{}), true);
    for (const Node& n : config.nodes) addNode(r, n, false);
}

} // namespace mural::config
