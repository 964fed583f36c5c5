// Tracks the frames that all living nodes have finished: the credit of programs, and the frame count of the wall.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "common/base/main_window.hpp"
#include "common/base/result.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

// The progress of one program.
struct ClientProgress {
    uint32_t finished = 0; // frames finished by all living nodes
    uint64_t calls = 0;    // GL calls up to the last frame, as reported by the fastest node
};

struct FrameTotals {
    int64_t wallFrames = 0; // frames of the main window, across changes of that window
    int64_t firstNs = 0;    // completion of the first and the latest of them
    int64_t latestNs = 0;
};

// Thread-safe. `credit` is called with the tracker's lock held, hence in order.
class FrameTracker {
public:
    // finished: frames finished by all living nodes. shown: frames up to which every picture has been shown.
    using Credit = std::function<void(uint32_t client, uint32_t finished, uint32_t shown)>;

    FrameTracker(int nodes, Credit credit);

    Result<void> frameDone(int node, const wire::FrameDoneMessage& message, int64_t nowNs);
    void nodeLost(int node, int64_t nowNs);
    // Adds nodes that are no members yet.
    void addNodes(size_t count);
    // The node is returning. Credit waits for it from now on, although its progress is still unknown.
    void nodeJoins(int node);
    // The node has returned. It finishes the frames after `before`; other nodes have finished the earlier ones.
    void nodeJoined(int node, const std::vector<wire::ClientFrame>& before, int64_t nowNs);
    void clientGone(uint32_t client);
    // Call after the last frame of this window from all nodes.
    void windowGone(uint32_t client, uint32_t window);

    // Announces a picture for the outputs. Must precede the completion of its frame.
    void delayPicture(uint32_t client, uint32_t frame);
    // Sets the X window of a window. Several drawables may belong to one X window.
    void isOn(uint32_t client, uint32_t window, uint64_t native);
    [[nodiscard]] uint64_t nativeOf(uint32_t client, uint32_t window) const; // 0: unknown
    // The program whose window the wall has shown last, and its X window, which is known while the head receives
    // pictures. client 0: none.
    struct ShownWindow {
        uint32_t client = 0;
        uint64_t native = 0;
    };
    [[nodiscard]] ShownWindow shownWindow() const;
    void pictureReleased(uint32_t client, uint32_t frame);

    [[nodiscard]] ClientProgress progressOf(uint32_t client) const;
    // The nodes that have not finished the frame after `finished`.
    [[nodiscard]] std::vector<int> behind(uint32_t client) const;
    [[nodiscard]] FrameTotals totals() const;
    [[nodiscard]] int64_t framesOf(int node) const; // frame messages of this node

private:
    struct Window {
        uint32_t id = 0;
        uint32_t width = 0;
        uint32_t height = 0;
    };
    // Frames arrive in order, except from programs that swap in several threads.
    struct NodeProgress {
        uint32_t done = 0;        // all frames up to here are done
        uint32_t joined = 0;      // frames up to here were finished by other nodes
        std::set<uint32_t> early; // finished frames beyond `done`
    };
    struct Client {
        std::vector<NodeProgress> nodes;
        std::map<uint32_t, Window> windows; // windows of frames that some nodes have not finished
        std::multiset<uint32_t> unshown;
        std::map<uint32_t, uint64_t> natives; // window → X window
        uint32_t finished = 0;                // by all living nodes
        uint64_t calls = 0;
        uint32_t credited = 0; // the last value of `finished` sent to the program
        uint32_t shown = 0;
    };

    Client& client(uint32_t id);
    void advance(uint32_t id, Client& c, int64_t nowNs);
    void giveCredit(uint32_t id, Client& c);
    void count(uint32_t id, const Window& window, int64_t nowNs);

    mutable std::mutex mutex_;
    const Credit credit_;
    std::vector<bool> living_;
    std::vector<int64_t> framesOf_;
    std::map<uint32_t, Client> clients_;
    MainWindow mainWindow_;
    ShownWindow shown_;
    FrameTotals totals_;
};

} // namespace mural
