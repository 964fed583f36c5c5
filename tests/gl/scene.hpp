// Small pictures that cover differences between framebuffers: depth, stencil, blending with the framebuffer's alpha,
// stipples, lines, points, bitmaps, derivatives, gl_FragCoord.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nodes/gl/gl_platform.hpp"
#include "tests/gl/gl_functions.hpp"

namespace mural::test {

// The readable content of a framebuffer. Planes that it lacks, or that the API cannot read, are empty.
struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> color;    // [y][x][rgba8], origin lower left; resolved if multisampled
    std::vector<uint8_t> readBack; // by glReadPixels: Mesa 22.3.6 returns one sample, unresolved
    std::vector<uint32_t> depth;
    std::vector<uint8_t> stencil;
    std::string error; // an error of GL or a shader; empty: none
};

// The context is current with a framebuffer made from config, which the picture fills. maskAlpha: as the replay does
// for Surface::hiddenAlpha().
Picture drawScene(const FindProc& find, const gl::ContextConfig& context, const gl::SurfaceConfig& config,
                  bool maskAlpha = false);

Picture readPicture(const GlFunctions& gl, const gl::ContextConfig& context, const gl::SurfaceConfig& config);

// Empty if every bit is equal. Otherwise the number of differing pixels per plane, the maximum difference, and the
// first position.
std::string difference(const Picture& expected, const Picture& actual);

// The number of colours: an empty picture proves nothing.
size_t countColors(const Picture& picture);

} // namespace mural::test
