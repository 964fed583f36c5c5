// Projection and view of one task. Pure.
//
// Every part of a picture has the projection of the whole picture, so that neighbours meet without seams. A part
// differs by viewport and scissor only.
#pragma once

#include <optional>

#include "common/geometry/frustum.hpp"
#include "common/geometry/matrix4.hpp"
#include "common/geometry/pixel_viewport.hpp"
#include "nodes/session/render_pass.hpp"
#include "nodes/session/screen_view.hpp"

namespace mural::native {

struct ViewInput {
    int32_t width = 1, height = 1;        // of the whole picture, in pixels of the window
    RenderPass pass;                      // eye, kernel, sample, zoom
    std::optional<ScreenView> screen;     // a screen of a room; null: a flat wall
    double eyeBase = 0, wallDistance = 1; // of a flat wall: between the eyes, and from the origin to the wall
    Matrix4 head;                         // pose of the observer's head in the room
    double nearPlane = 0.1, farPlane = 100;
};

// Height of a flat wall relative to its distance: 0.4 m at 0.75 m, as in Equalizer's default configuration.
constexpr double kWallHeight = 0.4 / 0.75;

// The projection of the picture of the pass, whose framebuffer is the pass's picture (nodes/player/pixel_mapping.hpp).
[[nodiscard]] Matrix4 projectionOf(const ViewInput& view);
[[nodiscard]] Matrix4 toEyeOf(const ViewInput& view);
// The frustum of `area`, in pixels of the pass's picture.
[[nodiscard]] Frustum frustumOf(const ViewInput& view, const PixelViewport& area);

} // namespace mural::native
