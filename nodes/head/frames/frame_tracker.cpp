#include "nodes/head/frames/frame_tracker.hpp"

#include <algorithm>
#include <limits>

namespace mural {
namespace {

// A frame number counts as skipped after this many later frames: its thread ended between taking the number and
// swapping.
constexpr size_t kMaxEarly = 16;
// The capacity of the streams bounds the lead of one node over another. A larger lead means a broken node.
constexpr size_t kMaxOpenFrames = size_t{1} << 20;

} // namespace

FrameTracker::FrameTracker(int nodes, Credit credit)
    : credit_(std::move(credit)), living_(static_cast<size_t>(nodes), true), framesOf_(static_cast<size_t>(nodes), 0) {}

FrameTracker::Client& FrameTracker::client(uint32_t id) {
    Client& c = clients_[id];
    c.nodes.resize(living_.size());
    return c;
}

Result<void> FrameTracker::frameDone(int node, const wire::FrameDoneMessage& m, int64_t nowNs) {
    const std::lock_guard lock(mutex_);
    Client& c = client(m.client);
    NodeProgress& progress = c.nodes[static_cast<size_t>(node)];
    if (progress.joined > 0 && m.frame <= progress.joined) return {}; // a late swap of another thread
    const bool repeated = m.frame <= progress.done || progress.early.contains(m.frame);
    if (repeated) return Error{"it reported frame " + std::to_string(m.frame) + " twice"};
    if (c.windows.size() >= kMaxOpenFrames) return Error{"it reported a frame number that is a million ahead"};
    ++framesOf_[static_cast<size_t>(node)];
    c.calls = std::max(c.calls, m.calls);
    if (m.frame > c.finished) c.windows.try_emplace(m.frame, Window{m.window, m.width, m.height});
    progress.early.insert(m.frame);
    if (progress.early.size() > kMaxEarly) progress.done = *progress.early.begin() - 1;
    while (!progress.early.empty() && *progress.early.begin() == progress.done + 1) {
        ++progress.done;
        progress.early.erase(progress.early.begin());
    }
    advance(m.client, c, nowNs);
    return {};
}

void FrameTracker::nodeLost(int node, int64_t nowNs) {
    const std::lock_guard lock(mutex_);
    living_[static_cast<size_t>(node)] = false;
    if (std::ranges::find(living_, true) == living_.end()) return;
    for (auto& [id, c] : clients_) advance(id, c, nowNs);
}

void FrameTracker::addNodes(size_t count) {
    const std::lock_guard lock(mutex_);
    living_.resize(living_.size() + count, false);
    framesOf_.resize(living_.size(), 0);
    for (auto& [id, c] : clients_) c.nodes.resize(living_.size());
}

void FrameTracker::nodeJoins(int node) {
    const std::lock_guard lock(mutex_);
    for (auto& [id, c] : clients_) {
        uint32_t known = c.finished;
        for (const NodeProgress& other : c.nodes)
            known = std::max({known, other.done, other.early.empty() ? 0 : *other.early.rbegin()});
        c.nodes[static_cast<size_t>(node)] = {known, known, {}};
    }
    living_[static_cast<size_t>(node)] = true;
}

void FrameTracker::nodeJoined(int node, const std::vector<wire::ClientFrame>& before, int64_t nowNs) {
    const std::lock_guard lock(mutex_);
    for (const wire::ClientFrame& frame : before) {
        Client& c = client(frame.client);
        NodeProgress& progress = c.nodes[static_cast<size_t>(node)];
        progress.done = progress.joined = std::max(progress.done, frame.frame);
        advance(frame.client, c, nowNs);
    }
}

void FrameTracker::clientGone(uint32_t id) {
    const std::lock_guard lock(mutex_);
    mainWindow_.clientGone(id);
    if (shown_.client == id) shown_ = {};
}

void FrameTracker::windowGone(uint32_t id, uint32_t window) {
    const std::lock_guard lock(mutex_);
    mainWindow_.windowGone(id, window);
    client(id).natives.erase(window);
}

void FrameTracker::delayPicture(uint32_t id, uint32_t frame) {
    const std::lock_guard lock(mutex_);
    client(id).unshown.insert(frame);
}

void FrameTracker::isOn(uint32_t id, uint32_t window, uint64_t native) {
    const std::lock_guard lock(mutex_);
    client(id).natives[window] = native;
}

FrameTracker::ShownWindow FrameTracker::shownWindow() const {
    const std::lock_guard lock(mutex_);
    return shown_;
}

uint64_t FrameTracker::nativeOf(uint32_t id, uint32_t window) const {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    if (found == clients_.end()) return 0;
    const auto native = found->second.natives.find(window);
    return native == found->second.natives.end() ? 0 : native->second;
}

void FrameTracker::pictureReleased(uint32_t id, uint32_t frame) {
    const std::lock_guard lock(mutex_);
    Client& c = client(id);
    const auto found = c.unshown.find(frame);
    if (found != c.unshown.end()) c.unshown.erase(found);
    giveCredit(id, c);
}

void FrameTracker::advance(uint32_t id, Client& c, int64_t nowNs) {
    uint32_t finished = std::numeric_limits<uint32_t>::max();
    for (size_t node = 0; node < living_.size(); ++node)
        if (living_[node]) finished = std::min(finished, c.nodes[node].done);
    if (finished <= c.finished) return;
    c.finished = finished;
    while (!c.windows.empty() && c.windows.begin()->first <= finished) {
        count(id, c.windows.begin()->second, nowNs);
        c.windows.erase(c.windows.begin());
    }
    giveCredit(id, c);
}

void FrameTracker::giveCredit(uint32_t id, Client& c) {
    uint32_t shown = c.finished;
    if (!c.unshown.empty()) shown = std::min(shown, *c.unshown.begin() - 1);
    shown = std::max(shown, c.shown); // a late swap of another thread does not decrease it
    if (c.finished == c.credited && shown == c.shown) return;
    c.credited = c.finished;
    c.shown = shown;
    credit_(id, c.finished, shown);
}

void FrameTracker::count(uint32_t id, const Window& window, int64_t nowNs) {
    const auto& natives = client(id).natives;
    const auto native = natives.find(window.id);
    const uint64_t onDisplay = native == natives.end() ? 0 : native->second;
    if (mainWindow_.swapped(id, window.id, window.width, window.height, onDisplay) == 0) return;
    shown_ = {id, onDisplay};
    if (totals_.wallFrames++ == 0) totals_.firstNs = nowNs;
    totals_.latestNs = nowNs;
}

ClientProgress FrameTracker::progressOf(uint32_t id) const {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    return found == clients_.end() ? ClientProgress{} : ClientProgress{found->second.finished, found->second.calls};
}

std::vector<int> FrameTracker::behind(uint32_t id) const {
    const std::lock_guard lock(mutex_);
    std::vector<int> nodes;
    const auto found = clients_.find(id);
    if (found == clients_.end()) return nodes;
    const Client& c = found->second;
    for (size_t node = 0; node < c.nodes.size(); ++node)
        if (living_[node] && c.nodes[node].done <= c.finished) nodes.push_back(static_cast<int>(node));
    return nodes;
}

FrameTotals FrameTracker::totals() const {
    const std::lock_guard lock(mutex_);
    return totals_;
}

int64_t FrameTracker::framesOf(int node) const {
    const std::lock_guard lock(mutex_);
    return framesOf_[static_cast<size_t>(node)];
}

} // namespace mural
