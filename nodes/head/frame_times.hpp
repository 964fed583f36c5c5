// How long each node was at work for each frame of one window: what those compare that deal out work.
//
// It is the largest window that is followed: its frames are those that times are taken for; what nodes do for other windows counts to
// them, too. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "streamcodec/wire.hpp"

namespace mural {

class FrameTimes {
public:
    // Of a frame that all living nodes have finished; by node.
    struct Frame {
        std::vector<double> busyNs;             // below 0: a node that does not live
        std::vector<wire::FrameDoneMessage> done;
    };

    explicit FrameTimes(size_t nodes) : lives_(nodes, true), workNs_(nodes, 0) {}

    // The first of all that is to be told of a message. True: another window is followed from now on, or its size is another.
    bool follow(const wire::FrameDoneMessage& message);
    [[nodiscard]] bool follows(const wire::FrameDoneMessage& message) const { return Window{message.client, message.window} == followed_; }
    void worked(int node, uint64_t busyNs) { workNs_[static_cast<size_t>(node)] += static_cast<double>(busyNs); }
    // Of a message that it follows.
    std::optional<Frame> finished(int node, const wire::FrameDoneMessage& message);

    // If it was followed, what has frames next will be.
    void windowGone(uint32_t client, uint32_t window); // or wire::kAllWindows
    void lost(int node);
    bool joined(int node); // false: it lived
    [[nodiscard]] bool lives(int node) const { return lives_[static_cast<size_t>(node)]; }

    [[nodiscard]] bool known() const { return width_ > 0; } // a window is followed
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

private:
    using Window = std::pair<uint32_t, uint32_t>; // client, window

    std::vector<bool> lives_;
    std::vector<double> workNs_; // by node, since its last frame of the followed window
    Window followed_{};
    int width_ = 0, height_ = 0;       // of it
    int others_ = 0;                   // frames of other windows since its last one
    std::map<uint32_t, Frame> frames_; // by number, of the followed window, that not all have finished
};

} // namespace mural
