// Semantics of files before versions 1.1 and 1.2 of the format.
#include <functional>

#include "balancer/config/resolving/attribute_filler.hpp"
#include "balancer/config/resolving/resolver.hpp"

namespace mural::config {

namespace {

// Visits the views that this compound and its descendants show.
void eachShownView(ResolvedConfig& config, Index compound, const std::function<void(ResolvedChannel&)>& use) {
    const ResolvedCompound& c = config.compounds[Resolver::at(compound)];
    if (c.destination != kNone) {
        ResolvedChannel& channel = config.channels[Resolver::at(c.destination)];
        if (channel.isDestination()) use(channel);
        return;
    }
    for (const Index child : c.children) eachShownView(config, child, use);
}

} // namespace

// Before 1.1 the eyes of compounds implied stereo; mono was implicit.
void mendVersion10(Resolver& r) {
    if (r.file.version >= 1.1) return;
    ResolvedConfig& config = r.out;
    if (config.nodes.size() > 1 && config.serverConnections.empty()) {
        Connection any;
        fillAttributes(any, "CONNECTION", r.defaults);
        any.port = 0;
        config.serverConnections.push_back(any);
    }
    if (config.nodes.size() > 1 && config.nodes.front().connections.empty()) {
        Connection any;
        fillAttributes(any, "CONNECTION", r.defaults);
        config.nodes.front().connections.push_back(any);
    }
    std::vector<EyeSet> eyes(config.segments.size());
    for (size_t i = 0; i < config.compounds.size(); ++i) {
        ResolvedCompound& c = config.compounds[i];
        if (c.channel != kNone && c.channel == c.destination &&
            config.channels[Resolver::at(c.channel)].isDestination()) {
            EyeSet own = kAllEyes;
            for (Index up = static_cast<Index>(i); up != kNone; up = config.compounds[Resolver::at(up)].parent) {
                if (!config.compounds[Resolver::at(up)].eyes) continue;
                own = *config.compounds[Resolver::at(up)].eyes;
                break;
            }
            EyeSet& segment = eyes[Resolver::at(config.channels[Resolver::at(c.channel)].segment)];
            segment = segment | own | EyeSet{Eye::Cyclop};
        }
        if (!c.eyes || c.eyes->has(Eye::Cyclop)) continue;
        eachShownView(config, static_cast<Index>(i), [&](ResolvedChannel& channel) {
            config.views[Resolver::at(channel.view)].mode = ViewMode::Stereo;
        });
    }
    for (ResolvedCompound& c : config.compounds) {
        if (c.eyes) c.eyes->add(Eye::Cyclop);
    }
    for (size_t s = 0; s < eyes.size(); ++s) {
        if (!eyes[s].empty()) config.segments[s].eyes = eyes[s];
    }
}

// Before 1.2 the launch host of a node was the host name of its connection.
void mendVersion11(Resolver& r) {
    const bool old = r.file.version < 1.2;
    for (ResolvedNode& node : r.out.nodes) {
        const std::string listens = node.connections.empty() ? "" : node.connections.front().hostname.value_or("");
        if (node.isApplication || listens.empty()) continue;
        if (!node.host.empty()) {
            if (old && node.host != listens)
                r.diagnostics.warn(node.at,
                                   "this node and its connection have different hosts; before version 1.2 the "
                                   "connection's host is used",
                                   "write #Equalizer 1.2 ascii, or remove one of them");
            if (old) node.host = listens;
            continue;
        }
        if (!old)
            r.diagnostics.warn(node.at, "this node has no host, the one of its first connection is used: " + listens,
                               "write host \"" + listens + "\"");
        node.host = listens;
    }
}

} // namespace mural::config
