// State of a program's window on this node, and of the window's current frame.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"
#include "gl_functions.hpp"
#include "nodes/exchange/part_composition.hpp"
#include "nodes/gl/gl_platform.hpp"
#include "nodes/player/readback_choice.hpp"
#include "nodes/session/range_assignment.hpp"
#include "nodes/session/viewport_assignment.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::replay {

struct ContextState;

// State of a window's frame in sort-last rendering.
struct RangeFrame {
    enum class Phase : uint8_t {
        Fresh, // nothing is drawn
        Split, // each node has drawn its range
        Whole  // composited: the collector draws the rest
    } phase = Phase::Fresh;
    GLbitfield cleared = 0; // buffers that were cleared whole since the frame began
    uint64_t cost = 0;      // of all draws so far, in vertices
    uint64_t lastTotal = 0; // cost of the previous frame; 0: unknown
    uint64_t serial = 0;    // number of compositions of this window
    GLenum function = 0;    // depth function of all shared draws
    bool muted = false;     // another node draws the current commands
    bool wasSplit = false;
    Range share;          // this node's part of lastTotal
    uint32_t shares = 0;  // number of the RangeAssignment with that part
    uint32_t drawnBy = 0; // number of the RangeAssignment of the previous frame
    // number of returned nodes of its picture when the frame began; the composition of the frame includes these
    // nodes
    uint64_t returns = 0;
    CompositeRule rule; // how the nodes' pictures are composited
};

// This node's part of a window whose tiles follow the load (features/dynamic_tiles.cpp).
struct MovingPart {
    std::shared_ptr<const ViewportAssignment> areas;  // the current ones
    std::shared_ptr<const ViewportAssignment> wanted; // the ones to apply at the next full clear
    GLbitfield drawn = 0; // buffers with only this node's part; all other buffers are complete on all nodes
    bool fixed = false;   // the areas never change again
    int64_t waits = 0;    // frames since other areas were announced
    std::shared_ptr<const ViewportAssignment> front; // of the front, where it has its own surface
};

struct Window {
    bool destroyed = false;         // freed when no stream has it current
    bool lean = false;              // the framebuffer has the region's size
    bool widens = true;             // to the window's size on demand; false after a failure
    wire::WindowConfig config{};    // with the channel bits of `surface`
    uint8_t programRed = 0;         // red bits of the program's window; equal on all nodes
    ContextState* drawer = nullptr; // the context that was last current with it for drawing; null: destroyed
    bool isFlat = false;            // the program's window has no depth and no stencil buffer; this node's surface may
    std::unique_ptr<gl::Surface> surface;
    // the front buffer, created on first use where surfaces have one colour buffer
    std::unique_ptr<gl::Surface> front;
    bool frontStale = false;             // its colours must be copied from `surface`
    gl::Surface* deep = nullptr;         // the surface with the valid depth and stencil; null: `surface`
    std::unique_ptr<gl::Context> filler; // draws depth and stencil if the program's context cannot
    PixelViewport whole;                 // 0, 0, width, height
    PixelViewport part;                  // this node's, by the areas or the grid
    PixelViewport region;                // `part` as it is drawn; empty while another node has the turn
    // pixels inside the scissor: the region, or the driver's bins that contain it (raster_bins.hpp)
    PixelViewport drawn;
    int64_t frames = 0; // number of frames begun, and below of turns begun (features/time_multiplex.cpp)
    int64_t turn = 0;
    bool turnOver = false;       // the frame is complete; the next drawing command begins another
    bool undecided = false;      // the frame has only cleared, and may begin the next node's turn
    bool fresh = false;          // the frame has begun the next node's turn
    int64_t dependentFrames = 0; // consecutive frames that built on their predecessor
    GLbitfield cleared = 0;      // buffers that were cleared whole since the frame began
    bool plain = true;           // drawn without the kernel of this pass; its pixels are selected at the end
    bool copied = true;          // pixels were read or copied, or selected texture levels: the next frame is plain
    int levelChecks = 0;    // draws of this frame that were checked for texture levels (features/whole_windows.cpp)
    bool requested = false; // pixels or bytes were requested in this frame
    // draws the whole window: a copy must find this pass's own pixels, and other tiles deliver another pass's
    bool drawsAll = true;
    bool filled = true; // the frame had copies: the next one draws the whole window
    RangeFrame range;
    MovingPart moving;
    bool keepsPicture = false; // one node has the turn permanently
    // this frame draws its scene into a framebuffer object (features/stereo_scenes.cpp)
    bool sceneElsewhere = false;
    bool sceneWasElsewhere = false; // the previous frame drew its scene into a framebuffer object
    bool begun = false;             // something was drawn since the last swap
    ReadbackChoice readback;
    bool skipped = false;             // its frames are not drawn (features/frame_skip.cpp)
    GLbitfield stale = 0;             // buffers with wrong content after skipped frames
    bool frontStaled = false;         // the front buffer is stale as well
    bool invalid = false;             // this frame depends on stale buffers
    std::vector<int16_t> accumulated; // values of `drawn`, rows bottom first; empty: none yet
};

} // namespace mural::replay
