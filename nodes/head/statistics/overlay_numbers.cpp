#include "nodes/head/statistics/overlay_numbers.hpp"

namespace mural {

OverlayNumbers::OverlayNumbers(const std::map<int, std::string>& names) {
    for (const auto& [node, name] : names) nodes_[node] = {name, {}};
}

std::vector<OverlayNode> OverlayNumbers::nodes() const {
    std::vector<OverlayNode> all;
    for (const auto& [number, node] : nodes_) all.push_back(node);
    return all;
}

// A reader of the head works for one node: the assembly of its pictures is a part of the node's frame.
void OverlayNumbers::add(const std::vector<FrameRecord>& records) {
    for (const FrameRecord& record : records) {
        if (record.number < next_) continue;
        next_ = record.number + 1;
        std::map<int, FrameParts> parts;
        for (const SpanTrack& track : record.tracks) {
            const bool isNode = track.process == SpanProcess::Node;
            if (!isNode && (track.process != SpanProcess::Head || track.thread != "reader")) continue;
            if (nodes_.contains(track.number))
                addParts(parts[track.number], track.spans, isNode && track.thread == "replay");
        }
        for (auto& [node, frame] : parts) {
            frame.frame = record.frame;
            frame.endNs = record.doneNs;
            nodes_[node].frames.add(frame);
        }
    }
}

} // namespace mural
