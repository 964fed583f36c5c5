// Configuration and outputs of a StreamPlayer: everything that its owner passes in and receives.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/picture_format.hpp"
#include "common/geometry/pixel_viewport.hpp"
#include "common/geometry/tile_grid.hpp"
#include "common/geometry/viewport.hpp"
#include "nodes/culling/culling_counts.hpp"
#include "nodes/exchange/part_composition.hpp"
#include "nodes/exchange/picture_part.hpp"
#include "nodes/frame_transfer/picture_read.hpp"
#include "nodes/session/culling_mode.hpp"
#include "nodes/session/viewport_assignment.hpp"
#include "nodes/session/readback.hpp"
#include "nodes/session/render_pass.hpp"
#include "nodes/session/screen_view.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

// Limits on the memory and work that a stream may cause on the node, far above the needs of programs.
struct PlayerLimits {
    uint64_t blobBytes = uint64_t{4} << 30;   // queued in one stream
    uint64_t answerBytes = uint64_t{2} << 30; // of one answer
    uint32_t listCommands = 1u << 24;         // executed by one call of a display list; nesting multiplies them
};

// This node's part of every picture.
struct PlayerConfig {
    int node = 0;
    TileGrid grid;
    TileRegion region;
    std::optional<Viewport> area;            // replaces grid and region
    std::optional<ViewportAssignment> areas; // replaces `area`; moveAreas() sets the following ones
    bool anyMovesZoom = false;               // the zooms of `areas` change, of any node; they apply to this node if…
    bool movesZoom = false;                  // …its own zoom changes
    RenderPass pass;
    std::vector<Range> ranges;     // the initial shares of all nodes of this picture, by rank; empty: there is one node
    bool answers = true;           // answers requests for pixels; false: nodes of another pass answer them
    bool isOnHeadsMachine = false; // processes of this machine share memory with the program
    double eyeBase = 0.05, focusDistance = 1; // in the program's units
    std::optional<ScreenView> screen;         // includes the position of the eye
    bool skips = false;                       // draws no frames until drawAgain()
    // The node is in resync, and other nodes have the turns. Until takeTurns() or beginTurns() the node draws all
    // frames and owns none of them. It shares no draws before resetShares().
    bool isResyncing = false;
    bool cull = false;                      // rewritten shaders drop whole primitives outside the region
    CullingMode culling = CullingMode::Off; // leaves out vertices that cannot touch its area
    bool lean = false;                      // framebuffers of the tile's size; false: of the picture's size (exact)
    bool rastersInBins = false; // the driver draws in software, so a region must end on its bins (raster_bins.hpp)
    Readback readback = Readback::Direct; // of Frame::read
    bool deepPictures = false;            // allows Bgr10A2 in Frame::format
    std::string plant;                    // MURAL_PLANT: a planted fault, which tests must detect
    PlayerLimits limits;
};

enum class ReadAhead : uint8_t {
    Received,
    Nothing, // no packet came before the deadline
    Ended,   // the program or the session has ended: no packet of this program follows
};

// Outputs of the player; called on its thread.
struct PlayerOutputs {
    // Part of a reply; `last` closes this node's part.
    std::function<void(const wire::ReplyPartHeader&, std::span<const std::byte>)> answer;
    // A frame of the window is complete. `pixels` reads the given rectangle in window coordinates. Rows are bottom
    // first and tightly packed. `pixels` is only valid during the call.
    struct Frame {
        uint32_t client, window, frame;
        wire::WindowConfig config;
        PixelViewport region;  // this node's part of the picture
        PictureFormat format;  // of `pixels` and `read`
        PixelViewport picture; // the complete picture: the window's size, or every nth pixel of it
        bool drawnWhole;       // every node drew the whole window (ShareGroup::allDrawn)
        bool keepsPicture;     // each frame builds on its predecessor, so one node draws all of them
        bool valid;            // does not depend on skipped draws (PlayerConfig::skips)
        bool notSplit;         // several ranges exist, but no draws were shared
        uint32_t areas;        // number of the ViewportAssignment that divides the picture
        uint32_t
            shares; // number of the RangeAssignment that divided the draws; 0: the initial ones, or no shared draws
        bool keepsAreas; // newer areas have waited too long for a full clear
        bool isUnzoomed; // drawn without the node's zoom
        std::function<const std::byte*(const PixelViewport&)> pixels;
        // Reads `region` once, for another thread, which may have to wait for its drawing. Set where `pixels` is.
        // Returns null if no picture is available.
        std::function<std::unique_ptr<PictureRead>()> read;
    };
    std::function<void(const Frame&)> frameDone;
    // Called when a reply about a window depends on skipped draws.
    std::function<void()> invalid;
    std::function<void(uint32_t client, uint32_t window)> windowGone; // the program has destroyed it
    // Sort-last (features/sort_last.cpp): composites the parts of all nodes of the picture. Afterwards the collector's
    // part is the whole picture. Returns the area of it that may have changed.
    // `order`: see PictureComposer::compose.
    std::function<PixelViewport(PicturePart&, const CompositeRule&, const std::vector<int>& order)> composeParts;
    // Reads the next packet of the stream while the player plays an earlier one, and passes it to
    // StreamPlayer::preview. Waits for it until the deadline.
    std::function<ReadAhead(Deadline)> readAhead;
    // A message about distributed objects to the program (native API).
    std::function<void(uint32_t client, std::span<const std::byte>)> objectRequest;
    // Driver events of a program's context.
    std::function<void(const wire::DriverEvent&, const std::string& text)> driverEvent;
};

struct PlayerCounts {
    uint64_t commands = 0, malformed = 0, lacking = 0, glErrors = 0, frames = 0, bytes = 0;
    culling::CullingCounts culling;
};

} // namespace mural
