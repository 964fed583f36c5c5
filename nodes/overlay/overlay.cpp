#include "nodes/overlay/overlay.hpp"

#include <utility>

namespace mural {

Overlay::Overlay(std::string host, std::string role) {
    content_.host = std::move(host);
    content_.role = std::move(role);
}

void Overlay::setMode(OverlayMode mode) {
    const std::lock_guard lock(mutex_);
    if (content_.mode == mode) return;
    content_.mode = mode;
    content_.nodes.clear(); // the numbers of an earlier time
    version_.fetch_add(1, std::memory_order_release);
    mode_.store(mode, std::memory_order_release);
}

void Overlay::setNodes(std::vector<OverlayNode> nodes) {
    const std::lock_guard lock(mutex_);
    if (content_.mode != OverlayMode::Stats) return;
    content_.nodes = std::move(nodes);
    version_.fetch_add(1, std::memory_order_release);
}

OverlayContent Overlay::content() const {
    const std::lock_guard lock(mutex_);
    return content_;
}

} // namespace mural
