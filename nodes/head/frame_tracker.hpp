// Which frames all living nodes have finished: the credit that lets programs go on, and the count of
// frames on the wall.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "common/main_window.hpp"
#include "common/result.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

// How far one program is.
struct ClientProgress {
    uint32_t finished = 0; // frames, by all living nodes
    uint64_t calls = 0;    // up to there, as the node that is ahead says
};

struct FrameTotals {
    int64_t wallFrames = 0;  // frames of the main window, over changes of that window
    int64_t firstNs = 0;     // when the first and the latest of them were finished
    int64_t latestNs = 0;
};

// All calls from any thread. `credit` is called under the tracker's lock, so in order.
class FrameTracker {
public:
    // finished: by all living nodes; shown: of these, no picture up to here still has to be shown.
    using Credit = std::function<void(uint32_t client, uint32_t finished, uint32_t shown)>;

    FrameTracker(int nodes, Credit credit);

    Result<void> frameDone(int node, const wire::FrameDoneMessage& message, int64_t nowNs);
    void nodeLost(int node, int64_t nowNs);
    // Nobody is given credit for what comes from now on without it, though it is not known yet how far it is.
    void nodeJoins(int node);
    // It finishes the frames behind these.
    void nodeJoined(int node, const std::vector<wire::ClientFrame>& before, int64_t nowNs);
    void clientGone(uint32_t client);
    // No frame of it comes any more from any node.
    void windowGone(uint32_t client, uint32_t window);

    // A picture that is about to be shown (--display app); held before its frame is finished.
    void pictureHeld(uint32_t client, uint32_t frame);
    void pictureReleased(uint32_t client, uint32_t frame);

    [[nodiscard]] ClientProgress progressOf(uint32_t client) const;
    // The nodes that others wait for: they have not finished the frame after `finished`.
    [[nodiscard]] std::vector<int> behind(uint32_t client) const;
    [[nodiscard]] FrameTotals totals() const;
    [[nodiscard]] int64_t framesOf(int node) const; // messages of this node

private:
    struct Window {
        uint32_t id = 0;
        uint32_t width = 0;
        uint32_t height = 0;
    };
    // Frames come in order but for programs that swap in several threads.
    struct NodeProgress {
        uint32_t done = 0;          // all up to here
        uint32_t joined = 0;        // up to here others have done what there was to do
        std::set<uint32_t> early;   // beyond
    };
    struct Client {
        std::vector<NodeProgress> nodes;
        std::map<uint32_t, Window> windows; // of frames that not all have finished
        std::multiset<uint32_t> held;
        uint32_t finished = 0; // by all living nodes
        uint64_t calls = 0;
        uint32_t credited = 0; // what the program was last told of finished
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
    FrameTotals totals_;
};

} // namespace mural
