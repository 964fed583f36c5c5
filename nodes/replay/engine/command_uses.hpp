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

} // namespace mural
