// Classifies commands for single features of the replay, from their traits (streamcodec/command_traits.hpp).
#pragma once

#include <cstdint>

namespace mural {

// Sort-last (features/sort_last.cpp).
enum class RangeUse : uint8_t { None, State, Clear, Draw, Begin, End, Vertex, Read, Memory, Feedback, Query };
RangeUse rangeUseOf(uint16_t opcode);

// Other eyes and screens (features/stereo_view.cpp).
enum class EyeUse : uint8_t { None, Matrix, Draw, List, Uniform, Buffer, Framebuffer };
EyeUse eyeUseOf(uint16_t opcode);

// Windows that a node draws whole although its pass shows part of the pixels (features/whole_windows.cpp).
enum class WholeUse : uint8_t {
    None,
    Copies,
    Level,     // defines the level that the second argument names
    Levels,    // the second argument is the number of defined levels
    Parameter, // sets a texture parameter, such as GL_GENERATE_MIPMAP
    AllLevels,
    Draw,
};
WholeUse wholeUseOf(uint16_t opcode);

// Culling (features/culling.cpp): what a command may change.
enum class CullUse : uint8_t {
    None,
    Draw,
    Matrices, // the matrix of the current mode
    MatrixMode,
    Raster,         // viewport, widths, modes
    Cap,            // enables or disables its first argument
    Arrays,         // layout of vertex arrays
    VertexArray,    // the current vertex array
    IndexBuffer,    // perhaps the index buffer: the first argument is a target
    BoundContents,  // contents of the buffer bound to the first argument
    NamedContents,  // contents of the buffer that the first argument names
    AllContents,    // contents of any buffer
    DeletedBuffers, // contents and layouts
    Program,        // the current program
    Link,           // any program
    Uniforms,
    Pops,      // state of the context
    List,      // executes a display list
    Immediate, // begins a primitive
    EndImmediate,
    ReadsPicture, // perhaps into a buffer
    Everything
};
CullUse cullUseOf(uint16_t opcode);

} // namespace mural
