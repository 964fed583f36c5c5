// Assembles whole pictures from the parts that nodes send at every swap.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/result.hpp"
#include "common/geometry/zoom.hpp"
#include "nodes/head/results/byte_buffer.hpp"
#include "nodes/head/results/reply_senders.hpp"
#include "nodes/output/picture.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

struct WindowPicture {
    uint32_t client = 0;
    uint32_t window = 0;
    uint32_t frame = 0;
    uint64_t nativeWindow = 0; // X window id, 0: none; bits 32 and up: number of its display (CaptureHeader::displays)
    std::shared_ptr<const OwnedPicture> picture;
    // pictures of the other canvases, in their order; null: out of memory
    std::vector<std::shared_ptr<const OwnedPicture>> others;
    bool isOnWall = true; // shown in the wall windows of the head, if it has them
};

// Sessions with several passes (render_pass.hpp) have a picture of each, which `compose` combines. A picture is
// complete when every living node has sent its part or has finished the frame without one. In the region of a lost node
// the picture keeps the pixels of the window's previous picture.
//
// Thread-safe. `deliver` is called under the lock, which keeps the order of frames. It must not block.
class PictureAssembler {
public:
    using Deliver = std::function<void(WindowPicture picture)>;

    // Combines the pictures of the passes, in their order and none empty, to the picture of the frame.
    using Compose = std::function<void(const std::vector<Picture>& passes, OwnedPicture& into)>;

    PictureAssembler(int nodes, Deliver deliver);
    // passOf: index of each node's pass. others: functions that compose the pictures of further canvases from the same
    // passes. sizes: zoom of each pass's picture relative to the program's. Empty: all sizes are equal.
    PictureAssembler(std::vector<int> passOf, Compose compose, Deliver deliver, std::vector<Compose> others = {},
                     std::vector<Zoom> sizes = {});

    Result<void> part(int node, const wire::PictureHeader& header, ByteBuffer rows);
    void frameDone(int node, uint32_t client, uint32_t window, uint32_t frame);
    void nodeLost(int node);
    // Adds a returned node. It sends parts of frames from this view on.
    void nodeJoins(int node, uint32_t view);
    void nodeInView(int node, uint32_t view);
    void clientGone(uint32_t client); // no node sends more parts of it
    // Frees the pictures. Call after the last message of the last node.
    void release();

private:
    using Key = std::tuple<uint32_t, uint32_t, uint32_t>;  // client, window, frame
    using WindowKey = std::tuple<uint32_t, uint32_t, int>; // client, window, pass

    struct Part {
        int pass;
        wire::PictureHeader header{};
        ByteBuffer rows;
    };
    // Kept until all nodes have finished the frame, because a node reports the end of a frame after its part.
    struct Open {
        std::vector<Part> parts;
        std::vector<bool> awaited;  // per node: it reports this frame and is not lost
        std::vector<bool> done;     // per node: no part is awaited
        std::vector<bool> finished; // per node: it has reported the frame's end
        bool delivered = false;
    };
    using OpenPictures = std::map<Key, Open>;

    OpenPictures::iterator opened(int node, uint32_t client, uint32_t window, uint32_t frame);
    OpenPictures::iterator settle(OpenPictures::iterator at);
    [[nodiscard]] static bool allOf(const std::vector<bool>& awaited, const std::vector<bool>& nodes);
    void deliver(const Key& key, const Open& open);
    void assemble(WindowPicture& result, const Open& open);
    std::shared_ptr<const OwnedPicture> composed(const Compose& compose, const std::vector<Picture>& passes);
    std::shared_ptr<const OwnedPicture> assemblePass(const WindowKey& key, const Open& open);
    std::shared_ptr<OwnedPicture> spare();
    std::shared_ptr<const OwnedPicture> latestOf(const WindowKey& key) const;
    void keepLatest(const WindowKey& key, std::shared_ptr<const OwnedPicture> picture);

    std::mutex mutex_;
    const Deliver deliver_;
    const Compose compose_;
    const std::vector<Compose> others_;
    const std::vector<Zoom> sizes_;
    const std::vector<int> passOf_;
    const int passes_;
    ReplySenders views_;
    OpenPictures open_;
    std::vector<std::shared_ptr<OwnedPicture>> made_; // reusable pictures
    // Latest pictures of the windows that swapped last, newest first.
    std::list<std::pair<WindowKey, std::shared_ptr<const OwnedPicture>>> latest_;
};

} // namespace mural
