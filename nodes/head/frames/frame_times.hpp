// Measures each node's busy time per frame of one window, the input of load balancing.
//
// The followed window is the largest one. Work for other windows between two of its frames counts as well. Not
// thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "streamcodec/wire/node_messages.hpp"

namespace mural {

class FrameTimes {
public:
    // A frame that all living nodes have finished; indexed by node.
    struct Frame {
        std::vector<double> busyNs; // negative: the node is lost
        std::vector<wire::FrameDoneMessage> done;
    };

    explicit FrameTimes(size_t nodes) : alive_(nodes, true), workNs_(nodes, 0) {}

    // Call first for each message. Returns true if the followed window or its size has changed.
    bool follow(const wire::FrameDoneMessage& message);
    [[nodiscard]] bool follows(const wire::FrameDoneMessage& message) const {
        return Window{message.client, message.window} == followed_;
    }
    void worked(int node, uint64_t busyNs) { workNs_[static_cast<size_t>(node)] += static_cast<double>(busyNs); }
    // For a message of the followed window. Returns the frame if this node was the last to finish it.
    std::optional<Frame> finished(int node, const wire::FrameDoneMessage& message);

    // If the window was followed, the next window with a frame replaces it.
    void windowGone(uint32_t client, uint32_t window); // or wire::kAllWindows
    void lost(int node);
    bool joined(int node); // returns false if the node was alive already
    [[nodiscard]] bool isAlive(int node) const { return alive_[static_cast<size_t>(node)]; }

    [[nodiscard]] bool known() const { return width_ > 0; } // a window is followed
    [[nodiscard]] uint32_t client() const { return followed_.first; }
    [[nodiscard]] uint32_t window() const { return followed_.second; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

private:
    using Window = std::pair<uint32_t, uint32_t>; // client, window

    std::vector<bool> alive_;
    std::vector<double> workNs_; // per node, since its last frame of the followed window
    Window followed_{};
    int width_ = 0, height_ = 0;       // of it
    int others_ = 0;                   // frames of other windows since the last frame of the followed one
    std::map<uint32_t, Frame> frames_; // incomplete frames of the followed window, by number
};

} // namespace mural
