// Whole pictures from the parts that the nodes send at every swap.
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

#include "common/result.hpp"
#include "common/zoom.hpp"
#include "nodes/head/byte_buffer.hpp"
#include "nodes/head/node_views.hpp"
#include "nodes/output/picture.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

struct WindowPicture {
    uint32_t client = 0;
    uint32_t window = 0;
    uint32_t frame = 0;
    uint64_t nativeWindow = 0; // X window id, 0: none; from bit 32 on the number of its display (CaptureHeader::displays)
    std::shared_ptr<const OwnedPicture> picture;
    std::vector<std::shared_ptr<const OwnedPicture>> others; // of the canvases beside the first, in their order; null: no memory
};

// Sessions with several passes (render_pass.hpp) get a picture of each, put together by `compose`.
// A picture is whole when every living node has sent its part or has finished the frame without one.
// Where a node was lost, the picture keeps what that window's picture before had there.
// All calls from any thread. `deliver` is called under the lock, so in the order of frames: it must
// not block.
class PictureAssembler {
public:
    using Deliver = std::function<void(WindowPicture picture)>;

    // Pictures of the passes in their order, none empty, to the picture of the frame.
    using Compose = std::function<void(const std::vector<Picture>& passes, OwnedPicture& into)>;

    PictureAssembler(int nodes, Deliver deliver);
    // passOf: the picture that each node draws a part of.
    // others: the pictures of further canvases, of the same passes. sizes: of each pass's picture, to that of the program; empty: they are alike.
    PictureAssembler(std::vector<int> passOf, Compose compose, Deliver deliver, std::vector<Compose> others = {}, std::vector<Zoom> sizes = {});

    Result<void> part(int node, const wire::PictureHeader& header, ByteBuffer rows);
    void frameDone(int node, uint32_t client, uint32_t window, uint32_t frame);
    void nodeLost(int node);
    // It sends parts of the frames from this view on.
    void nodeJoins(int node, uint32_t view);
    void nodeInView(int node, uint32_t view);
    void clientGone(uint32_t client); // no node sends anything of it any more

private:
    using Key = std::tuple<uint32_t, uint32_t, uint32_t>; // client, window, frame
    using WindowKey = std::tuple<uint32_t, uint32_t, int>; // client, window, pass

    struct Part {
        int pass;
        wire::PictureHeader header{};
        ByteBuffer rows;
    };
    // Kept until all nodes have finished the frame: who sent a part says so after it.
    struct Open {
        std::vector<Part> parts;
        std::vector<bool> awaited;  // per node: it speaks of this frame, unless it is lost
        std::vector<bool> done;     // per node: no part of it is awaited
        std::vector<bool> finished; // per node
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
    NodeViews views_;
    OpenPictures open_;
    std::vector<std::shared_ptr<OwnedPicture>> made_; // memory of pictures, for the next ones
    // Latest picture of the windows that swapped last, the newest first.
    std::list<std::pair<WindowKey, std::shared_ptr<const OwnedPicture>>> latest_;
};

} // namespace mural
