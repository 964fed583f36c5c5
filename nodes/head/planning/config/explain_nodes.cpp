#include "nodes/head/planning/config/explain_nodes.hpp"

#include <cstdio>

namespace mural {
namespace {

std::string scaledTransfer(const NodePlan& n) {
    if (n.transferScale.none()) return {};
    char text[64];
    std::snprintf(text, sizeof text, "transferred at %.4g by %.4g times the size, ", n.transferScale.x,
                  n.transferScale.y);
    return text;
}

} // namespace

std::string bracketed(const Viewport& v) {
    char text[112];
    std::snprintf(text, sizeof text, "[ %.9g %.9g %.9g %.9g ]", v.x, v.y, v.w, v.h);
    return text;
}

void explainNodes(const ConfigSource& source, const std::vector<compound::Index>& channels, int nodesBefore,
                  SessionPlan& plan) {
    for (size_t i = 0; i < plan.nodes.size(); ++i) {
        const NodePlan& n = plan.nodes[i];
        const std::string pass = describe(n.pass);
        plan.explain.push_back(
            "node " + std::to_string(nodesBefore + n.node) + " (" + n.where + ") draws for channel \"" +
            source.channelName(channels[i]) + "\" " + (pass.empty() ? "" : pass + ", ") + scaledTransfer(n) +
            "the part " + bracketed(*n.area) + " of the wall" + (n.shown ? ", shown in " + bracketed(*n.shown) : ""));
    }
}

} // namespace mural
