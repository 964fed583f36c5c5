#include "nodes/render/windows/overlay_part.hpp"

#include <unistd.h>
#include <vector>

#include "common/base/clock.hpp"
#include "nodes/frame_spans/frame_spans_message.hpp"
#include "nodes/render/command_arguments.hpp"

namespace mural {

namespace {

constexpr int64_t kNumbersNs = 400 * kNsPerMs; // faster changes are hard to read, and each costs 6 ms at 1920x1080

std::string ownHost() {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

} // namespace

OverlayPart::OverlayPart(const NodeSetup& setup)
    : node_(static_cast<size_t>(setup.node)),
      name_("node " + std::to_string(setup.node)),
      overlay_(std::make_shared<Overlay>(ownHost(), name_)) {
    show(setup.overlay);
}

bool OverlayPart::take(std::span<const std::byte> modes) {
    if (modes.size() % sizeof(uint32_t) != 0) return false;
    const auto all = argumentList<uint32_t>(modes);
    if (node_ >= all.size()) return true; // older than this node
    if (all[node_] > static_cast<uint32_t>(kLastOverlayMode)) return false;
    show(static_cast<OverlayMode>(all[node_]));
    return true;
}

void OverlayPart::show(OverlayMode mode) {
    const std::lock_guard lock(mutex_);
    if (mode == overlay_->mode()) return;
    overlay_->setMode(mode);
    history_ = {};
    showNumbers();
}

void OverlayPart::showNumbers() {
    shownNs_ = monotonicNowNs();
    overlay_->setNodes({{name_ + " on " + ownHost(), history_}});
}

void OverlayPart::frameSpans(std::span<const std::byte> header, std::span<const std::byte> spans) {
    const auto head = argument<wire::FrameSpansHeader>(header);
    if (overlay_->mode() != OverlayMode::Stats || !head) return;
    const auto all = argumentList<wire::FrameSpan>(spans);
    FrameParts parts;
    parts.frame = head->frame;
    parts.endNs = head->sentNs;
    addParts(parts, spansOf(all, wire::SpanThread::Replay), true);
    addParts(parts, spansOf(all, wire::SpanThread::Pictures), false);
    const std::lock_guard lock(mutex_);
    history_.add(parts);
    if (monotonicNowNs() - shownNs_ >= kNumbersNs) showNumbers();
}

} // namespace mural
