// Small pictures that touch what differs between framebuffers: depth, stencil, blending with the
// framebuffer's alpha, stipples, lines, points, bitmaps, derivatives, gl_FragCoord.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nodes/gl/gl_platform.hpp"
#include "tests/gl/gl_functions.hpp"

namespace mural::test {

// All that can be read of a framebuffer. Planes that it lacks, or that the API can't read, are empty.
struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> color;    // [y][x][rgba8], origin lower left; resolved where it is multisampled
    std::vector<uint8_t> readBack; // as glReadPixels gives it: Mesa 22.3.6 gives one sample, unresolved
    std::vector<uint32_t> depth;
    std::vector<uint8_t> stencil;
    std::string error;            // not empty: GL or a shader reported it
};

// The context is current with a framebuffer made of config; the picture fills it.
// maskAlpha: as the replay does for Surface::hiddenAlpha().
Picture drawScene(const FindProc& find, const gl::ContextConfig& context, const gl::SurfaceConfig& config,
                  bool maskAlpha = false);

Picture readPicture(const GlFunctions& gl, const gl::ContextConfig& context, const gl::SurfaceConfig& config);

// Empty: equal in every bit. Else how many pixels of which plane differ, by how much, and where first.
std::string difference(const Picture& expected, const Picture& actual);

// How many colours the picture has: one that shows nothing proves nothing.
size_t countColors(const Picture& picture);

} // namespace mural::test
