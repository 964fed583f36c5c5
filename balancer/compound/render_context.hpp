// All that a channel must know to draw its part of one eye's picture.
#pragma once

#include "balancer/compound/frame_input.hpp"
#include "common/frustum.hpp"
#include "common/jitter.hpp"

namespace mural::compound {

enum class DrawBuffer : uint8_t { Back, BackLeft, BackRight };
enum class StereoMode : uint8_t { Passive, Quad, Anaglyph };

// Where a context's pixels lie among those of its destination, along one axis: pixel i of the context stands for pixel
// origin + scale · (kernel + i · step) there, counted from the destination's edge.
struct PixelAxis {
    double origin = 0;
    double scale = 1; // destination pixels per pixel, where the context is zoomed
    int32_t kernel = 0;
    int32_t step = 1;

    // The edges of the context's n pixels when each of them is as wide as `step` pixels of the destination and lies
    // around the middle of the one that it stands for.
    [[nodiscard]] double first() const { return origin + scale * (kernel + .5 - step / 2.); }
    [[nodiscard]] double last(int32_t n) const { return first() + scale * step * n; }
};

struct RenderContext {
    Index compound = kNone;
    Index channel = kNone;     // which draws
    Index destination = kNone; // for which it is drawn
    Index view = kNone;
    Eye eye = Eye::Cyclop;
    uint32_t taskId = 0; // counts within a frame

    PixelViewport viewport; // in the channel's window
    PixelViewport area;     // the same in the destination's window; its corner is the context's offset
    Viewport part;          // of the view: without pixel kernels
    Viewport sampledPart;   // of the view, moved and widened so that each pixel is the middle of the one that it stands for
    PixelAxis x, y;
    Range range;
    PixelKernel pixel;
    SubPixel subPixel;
    Jitter jitter; // of the subpixel; not in the frusta
    Zoom zoom;
    uint32_t period = 1;
    uint32_t phase = 0;
    Overdraw overdraw; // of the destination

    config::BufferSet buffers; // that are read back
    DrawBuffer drawBuffer = DrawBuffer::Back;
    config::ColorMask colorMask{config::ColorComponent::Red, config::ColorComponent::Green, config::ColorComponent::Blue};
    StereoMode stereoMode = StereoMode::Passive;
    config::ColorMask eyeColors{config::ColorComponent::Red, config::ColorComponent::Green, config::ColorComponent::Blue}; // that the eye has in an anaglyph

    Frustum perspective;
    Frustum destinationPerspective; // of all the destination's pixels
    Matrix4 perspectiveHead; // from the room to the eye, looking at the screen
    Frustum orthographic;
    Matrix4 orthographicHead;
    bool behindScreen = false; // the eye looks from the screen's back: the picture is mirrored
};

} // namespace mural::compound
