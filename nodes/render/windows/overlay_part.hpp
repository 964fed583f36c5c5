// A node's part of the overlay: its mode, and the numbers that its own windows show. Used by the replay thread; another
// one may call frameSpans().
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "nodes/overlay/overlay.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

class OverlayPart {
public:
    explicit OverlayPart(const NodeSetup& setup);

    [[nodiscard]] std::shared_ptr<const Overlay> overlay() const { return overlay_; }
    // Takes the arguments of HeadCommand::Overlay. Returns false if they are invalid.
    bool take(std::span<const std::byte> modes);
    // Adds the spans of a frame: FrameSpansHeader, FrameSpan*.
    void frameSpans(std::span<const std::byte> header, std::span<const std::byte> spans);

private:
    void show(OverlayMode mode);
    void showNumbers(); // requires mutex_

    const size_t node_;
    const std::string name_;
    const std::shared_ptr<Overlay> overlay_;
    std::mutex mutex_; // guards the members below
    FrameHistory history_;
    int64_t shownNs_ = 0; // the latest showNumbers()
};

} // namespace mural
