// Counts of culling on one node, for the report.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::culling {

// The first reason for which a draw of a window is not examined.
enum class WhyWhole : uint8_t {
    None,
    FramebufferObject,
    Replicated,   // every node draws the picture, or this node draws all of it
    MovedPicture, // another eye, sample or screen, or every nth pixel
    NoDepth,      // the window has neither a depth nor a stencil buffer
    OpenQuery,    // a query counts vertices or primitives, or vertices are captured
    Memory,       // shaders may write memory
    Stipple,      // the pattern of lines goes on from draw to draw
    Command,      // an indirect, multiple or instanced draw, or one of captured vertices
    Es,           // OpenGL ES, whose buffers cannot be read
    ClientMemory, // arrays or indices in client memory
    ArbProgram,   // a vertex program in assembly language
    Shader,       // the position is not a linear function of the attributes
    Attribute,    // an attribute without array, or with a type or divisor without boxes
    Viewports,    // several viewports, or a clip origin at the top
    NotFinite,    // vertices outside of their array, or not finite
    FirstUse,     // the contents have not been drawn before
    Count
};
[[nodiscard]] const char* nameOf(WhyWhole why);

struct CullingCounts {
    bool isOn = false;
    uint64_t drawsLeftOut = 0, drawsCut = 0, drawsWhole = 0;
    uint64_t verticesLeftOut = 0, verticesDrawn = 0;
    // vertices of draws that were not examined, by reason; they also count as drawn
    std::array<uint64_t, static_cast<size_t>(WhyWhole::Count)> unexamined{};
    uint64_t boxBytes = 0;           // largest memory of the boxes
    uint64_t audits = 0, faults = 0; // audited draws; draws with a sample in the area
};

} // namespace mural::culling
