#include "nodes/head/statistics/overlay_numbers.hpp"

#include <map>
#include <utility>

namespace mural {

OverlayNumbers::OverlayNumbers(std::vector<std::string> names) {
    for (std::string& name : names) {
        places_.push_back(name.empty() ? std::nullopt : std::optional(nodes_.size()));
        if (!name.empty()) nodes_.push_back({std::move(name), {}});
    }
}

// A reader of the head works for one node: the assembly of its pictures is a part of the node's frame.
void OverlayNumbers::add(const std::vector<FrameRecord>& records) {
    for (const FrameRecord& record : records) {
        if (record.number < next_) continue;
        next_ = record.number + 1;
        std::map<size_t, FrameParts> parts;
        for (const SpanTrack& track : record.tracks) {
            const bool isNode = track.process == SpanProcess::Node;
            if (!isNode && (track.process != SpanProcess::Head || track.thread != "reader")) continue;
            const auto number = static_cast<size_t>(track.number);
            if (track.number < 0 || number >= places_.size() || !places_[number]) continue;
            addParts(parts[*places_[number]], track.spans, isNode && track.thread == "replay");
        }
        for (auto& [node, frame] : parts) {
            frame.frame = record.frame;
            frame.endNs = record.doneNs;
            nodes_[node].frames.add(frame);
        }
    }
}

} // namespace mural
