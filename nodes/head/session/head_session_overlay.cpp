// The session's overlay over the pictures of the wall (docs/guide/walls.md). The head's windows show it, and nodes in
// theirs.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/log/log.hpp"
#include "nodes/head/session/head_session.hpp"
#include "streamcodec/wire/head_messages.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Kind = ControlArgument::Kind;

constexpr int64_t kOverlayNumbersNs =
    400 * kNsPerMs; // faster changes are hard to read, and four nodes cost 25 ms at 1920x1080

} // namespace

std::shared_ptr<Overlay> HeadSession::makeOverlay(std::shared_ptr<Overlay> given, OverlayMode mode) {
    if (!given) given = std::make_shared<Overlay>("", "head");
    given->setMode(mode);
    return given;
}

void HeadSession::addOverlayOperation(ControlOperations& operations) {
    operations.add(
        {"overlay",
         "overlay [MODE] [NODE]",
         "the overlay over the wall's windows; with MODE it changes them all, or those of NODE",
         {{"mode", Kind::Text, false, kOverlayModeNames}, {"node", Kind::Whole, false, "number of the node, from 0"}},
         [this](const Json& arguments) { return changeOverlay(arguments); }});
}

Result<Json> HeadSession::changeOverlay(const Json& arguments) {
    const auto name = arguments.find("mode");
    const auto node = arguments.find("node");
    if (name == arguments.end() && node != arguments.end())
        return Error{"node needs a mode: " + std::string(kOverlayModeNames)};
    if (name != arguments.end()) {
        const auto text = name->get<std::string>();
        const auto mode = overlayModeOf(text);
        if (!mode) return Error{"no overlay \"" + text.substr(0, 60) + "\"; choose " + kOverlayModeNames};
        if (finishing_) return Error{"the session is ending; its overlay does not change any more"};
        if (node != arguments.end()) {
            if (const auto known = checkNode(node->get<int64_t>()); !known) return known.error();
            const std::lock_guard lock(announceMutex_);
            overlayOfNodes_[static_cast<int>(node->get<int64_t>())] = *mode;
        } else {
            const std::lock_guard lock(announceMutex_);
            overlayMode_ = *mode;
            overlayOfNodes_.clear();
            overlay_->setMode(*mode);
        }
        log::info(log::Topic::Output, "the overlay changes to ", text, " at the request of mural ctl overlay");
        announceOverlay();
    }
    return overlayJson();
}

OverlayMode HeadSession::overlayOf(int node) const {
    const auto own = overlayOfNodes_.find(node);
    return own == overlayOfNodes_.end() ? overlayMode_ : own->second;
}

Json HeadSession::overlayJson() {
    const std::lock_guard lock(announceMutex_);
    Json nodes = Json::array();
    const auto plan = currentPlan();
    for (const NodePlan& node : plan->nodes)
        if (!node.isVacant) nodes.push_back({{"node", node.node}, {"overlay", nameOf(overlayOf(node.node))}});
    return {{"overlay", nameOf(overlayMode_)}, {"nodes", std::move(nodes)}};
}

// The lock orders the announcements of two threads. The calling thread must not wait for a node.
void HeadSession::announceOverlay() {
    const std::lock_guard lock(announceMutex_);
    std::vector<OverlayMode> modes;
    for (int node = 0; node < nodeCount(); ++node) modes.push_back(overlayOf(node));
    nodes_.scheduleSoon(wire::HeadCommand::Overlay, std::as_bytes(std::span(modes)));
}

bool HeadSession::showsStatistics() {
    const std::lock_guard lock(announceMutex_);
    return overlayMode_ == OverlayMode::Stats ||
           std::ranges::any_of(overlayOfNodes_, [](const auto& own) { return own.second == OverlayMode::Stats; });
}

// Requests statistics while an overlay shows them, and passes them on to the head's windows.
void HeadSession::tickOverlay(int64_t nowNs) {
    if (nowNs - overlayNumbersNs_ < kOverlayNumbersNs) return;
    overlayNumbersNs_ = nowNs;
    if (!showsStatistics()) {
        overlayNumbers_.reset();
        overlayPlan_.reset();
        return;
    }
    if (statistics_.request(nowNs)) announceStatistics();
    if (overlay_->mode() != OverlayMode::Stats) return;
    const auto plan = currentPlan();
    if (!overlayNumbers_ || overlayPlan_ != plan) {
        const std::string host = overlay_->content().host;
        std::map<int, std::string> names;
        for (const NodePlan& node : plan->nodes)
            if (!node.isVacant)
                names[node.node] = "node " + std::to_string(node.node) + " on " +
                                   (node.reach == NodeReach::SharedMemory && !host.empty() ? host : node.where);
        overlayNumbers_.emplace(names);
        overlayPlan_ = plan;
    }
    overlayNumbers_->add(statistics_.since(overlayNumbers_->next(), nowNs));
    overlay_->setNodes(overlayNumbers_->nodes());
}

} // namespace mural
