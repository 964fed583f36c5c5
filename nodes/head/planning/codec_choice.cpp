#include "nodes/head/planning/codec_choice.hpp"

#include <map>

#include "nodes/frame_transfer/plane_codecs.hpp"

namespace mural {

namespace {

std::string described(const std::string& codec) {
    if (codec == kQuickestCodec) return "encoded losslessly with the fastest codec, changed tiles only";
    if (codec == kLossyCodec) return "encoded with the fastest codec, which may be lossy, changed tiles only";
    return "encoded with " + codec + (mayLose(codec) ? " (lossy)" : "") + ", changed tiles only";
}

} // namespace

void chooseCodecs(SessionPlan& plan, const std::string& requested) {
    std::map<std::string, int> nodes;
    for (NodePlan& node : plan.nodes) {
        if (requested != kQuickestCodec) node.codec = requested;
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
