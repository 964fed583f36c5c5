// Traits of the GL commands: the one description by which capture, replay, filters and traces classify commands.
// Generated from the option `traits` of api/semantics.txt. Any thread.
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
    Bitmap,        // Pixels that drivers may batch
    Accumulates,   // Pixels of the accumulation buffer
    Clear,         // glClear
    ClearBuffer,   // one buffer of the bound framebuffer
    ClearNamed,    // one buffer of a named framebuffer
    // Values of a ClearBuffer's first argument that are valid for a window
    ClearsColor,
    ClearsDepth,
    ClearsStencil,
    ClearsDepthStencil,
    Begin,
    End,
    Vertex,   // of the open primitive
    Position, // a Vertex whose only arguments are its coordinates
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
    AttachesLayer,     // attaches one layer of a texture
    BufferContents,    // uploads to a buffer
    ImageBinding,      // image units of shaders
    BufferBinding,     // indexed buffers
    PixelTransfer,     // changes the transfer of images to textures and framebuffers
    TurnsOff,          // disables what its counterpart enables
    Indexed,           // applies to one buffer or stream: the second argument is its index
    ArrayIndex,        // sets an array of a vertex attribute or binding: the first argument is its index

    // Sections of the stream
    FeedbackBegin,
    FeedbackEnd,
    FeedbackDraw, // a Draw of captured vertices
    QueryBegin,
    QueryEnd,

    // Arguments
    EnumAsNumber, // an enum is passed as a number
    StandsAlone,  // state that no other command sets in part

    // Programs
    SamplerUniform, // sets integers, which are texture units if the uniform is a sampler
    LinkInput,      // takes effect when the program is linked

    // Textures and memory
    TextureLevel,     // defines the level that the second argument names
    TextureLevels,    // defines as many levels as the second argument says
    TextureAnyLevel,  // may define any level
    TextureParameter, // the second argument names the parameter
    Multisample,      // the second argument is the number of samples
    Immutable,        // defines storage that no later command replaces
    Allocates,        // may raise GL_OUT_OF_MEMORY
    ImageHandle,      // handles of images, not of textures

    Count
};
static_assert(static_cast<int>(Trait::Count) <= 64);

// Masks by opcode. Zero for Mural's own records and for commands that are never sent.
extern const std::array<uint64_t, op::kLimit> kCommandTraits;

constexpr uint64_t bitOf(Trait trait) { return uint64_t{1} << static_cast<int>(trait); }

inline uint64_t traitsOf(uint32_t opcode) { return opcode < op::kLimit ? kCommandTraits[opcode] : 0; }

// Returns true if the command has at least one of the traits.
template <class... Traits> bool hasTrait(uint32_t opcode, Traits... traits) {
    return (traitsOf(opcode) & (bitOf(traits) | ...)) != 0;
}

} // namespace mural
