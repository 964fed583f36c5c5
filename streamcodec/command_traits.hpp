// Traits of the GL commands: the one description that capture, replay, filters and recordings classify commands by.
// Generated from the option `traits` of registry/semantics.txt. Any thread.
#pragma once

#include <array>
#include <cstdint>

#include "gl_opcodes.hpp"

namespace mural {

// The number of a bit in the mask of a command.
enum class Trait : uint8_t {
    // Class `draw` of the registry: the program's own context skips the command, or runs it without changing pixels.
    DrawClass,

    // Output to the draw framebuffer
    Draw,          // primitives from arrays, meshes, evaluators; rectangles
    DrawRectangle, // a Draw in window coordinates, without viewport and vertex shader
    SkippableDraw, // a Draw that changes only pixels, feedback, queries and shader memory
    Pixels,        // images, bitmaps, and copies from the read framebuffer
    AllPlanes,     // Pixels of colour, depth or stencil, selected by an argument
    Clear,         // glClear
    ClearBuffer,   // one buffer of the bound framebuffer
    ClearNamed,    // one buffer of a named framebuffer
    Begin,
    End,
    Vertex, // of the open primitive
    CallList,

    // Other work
    ReadsFramebuffer, // copies from the read framebuffer
    Compute,
    Barrier,

    // State
    OrderState,     // tests, blending, masks, programs, framebuffers: decides whether the order of opaque draws matters
    Matrix,         // changes a matrix
    Viewport,       // changes a viewport
    RasterPosition, // a raster position, transformed like a vertex
    UniformMatrix4, // square matrices of four rows
    FramebufferObject, // binds, changes or deletes framebuffers or attachments
    BufferContents,    // uploads to a buffer
    ImageBinding,      // image units of shaders
    BufferBinding,     // indexed buffers

    // Sections of the stream
    FeedbackBegin,
    FeedbackEnd,
    FeedbackDraw, // a Draw of captured vertices
    QueryBegin,
    QueryEnd,

    // Arguments
    EnumAsNumber, // an enum is passed as a number
    StandsAlone,  // state that no other command sets in part

    // Textures and memory
    TextureLevel,     // defines the level that the second argument names
    TextureLevels,    // defines as many levels as the second argument says
    TextureAnyLevel,  // may define any level
    TextureParameter, // the second argument names the parameter
    Allocates,        // may raise GL_OUT_OF_MEMORY

    Count
};
static_assert(static_cast<int>(Trait::Count) <= 64);

// Masks by opcode. Zero for Mural's own records and for commands that are never sent.
extern const std::array<uint64_t, op::kLimit> kCommandTraits;

constexpr uint64_t bitOf(Trait trait) { return uint64_t{1} << static_cast<int>(trait); }

// Returns true if the command has at least one of the traits.
template <class... Traits> bool hasTrait(uint32_t opcode, Traits... traits) {
    return opcode < op::kLimit && (kCommandTraits[opcode] & (bitOf(traits) | ...)) != 0;
}

} // namespace mural
