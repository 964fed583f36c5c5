// The render context: everything that a channel needs to draw its part of one eye's picture.
#pragma once

#include "balancer/compound/frame_input.hpp"
#include "common/geometry/frustum.hpp"
#include "common/geometry/jitter.hpp"

namespace mural::compound {

enum class DrawBuffer : uint8_t { Back, BackLeft, BackRight };
enum class StereoMode : uint8_t { Passive, Quad, Anaglyph };

// Mapping of a context's pixels to those of its destination, along one axis. Pixel i of the context represents pixel
// origin + scale * (kernel + i * step) of the destination, counted from the destination's edge.
struct PixelAxis {
    double origin = 0;
    double scale = 1; // destination pixels per context pixel; not 1 with a zoom
    int32_t kernel = 0;
    int32_t step = 1;

    // Edges of the context's n pixels, each `step` destination pixels wide and centred on the pixel that it represents.
    [[nodiscard]] double first() const { return origin + scale * (kernel + .5 - step / 2.); }
    [[nodiscard]] double last(int32_t n) const { return first() + scale * step * n; }
};

struct RenderContext {
    Index compound = kNone;
    Index channel = kNone;     // drawing channel
    Index destination = kNone; // destination channel
    Index view = kNone;
    Eye eye = Eye::Cyclop;
    uint32_t taskId = 0; // unique within a frame

    PixelViewport viewport; // in the channel's window
    PixelViewport area;     // in the destination's window; its corner is the context's offset
    Viewport part;          // part of the view, without pixel kernels
    // part of the view, moved and widened so that each pixel centre is the centre of the represented pixel
    Viewport sampledPart;
    PixelAxis x, y;
    Range range;
    PixelKernel pixel;
    SubPixel subPixel;
    Jitter jitter; // subpixel jitter; not contained in the frusta
    Zoom zoom;
    uint32_t period = 1;
    uint32_t phase = 0;
    Overdraw overdraw; // of the destination

    config::BufferSet buffers; // buffers to read back
    DrawBuffer drawBuffer = DrawBuffer::Back;
    config::ColorMask colorMask{config::ColorComponent::Red, config::ColorComponent::Green,
                                config::ColorComponent::Blue};
    StereoMode stereoMode = StereoMode::Passive;
    // colours of the eye in an anaglyph
    config::ColorMask eyeColors{config::ColorComponent::Red, config::ColorComponent::Green,
                                config::ColorComponent::Blue};

    Frustum perspective;
    Frustum destinationPerspective; // for all pixels of the destination
    Matrix4 perspectiveHead;        // from room to eye, looking at the screen
    Frustum orthographic;
    Matrix4 orthographicHead;
    bool behindScreen = false; // the eye is behind the screen: the picture is mirrored
};

} // namespace mural::compound
