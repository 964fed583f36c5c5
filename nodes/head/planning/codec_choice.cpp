#include "nodes/head/planning/codec_choice.hpp"

#include <map>

#include "nodes/frame_transfer/plane_codecs.hpp"

namespace mural {

namespace {

std::string described(const std::string& codec) {
    if (codec == kQuickestCodec)
        return "packed by what gets them there soonest and loses nothing, without tiles that have not changed";
    if (codec == kLossyCodec)
        return "packed by what gets them there soonest, and may lose something, without tiles that have not changed";
    return "packed by " + codec + (mayLose(codec) ? ", which loses something" : "") +
           ", without tiles that have not changed";
}

} // namespace

void chooseCodecs(SessionPlan& plan, const std::string& asked) {
    std::map<std::string, int> nodes;
    for (NodePlan& node : plan.nodes) {
        if (asked != kQuickestCodec) node.codec = asked;
        const bool byMemory = node.reach == NodeReach::SharedMemory;
        node.pictureCodec = byMemory && node.codec == kQuickestCodec ? kRawCodec : node.codec;
        ++nodes[node.pictureCodec];
    }
    for (const auto& [codec, count] : nodes)
        if (codec != kRawCodec)
            plan.explain.push_back("pictures of " + std::to_string(count) + (count == 1 ? " node" : " nodes") +
                                   " come " + described(codec));
}

} // namespace mural
