// What a record is to `mural trim`.
#pragma once

#include <cstdint>

namespace mural::recording {

enum class Role : uint8_t {
    Other,      // kept, and of no consequence for pictures
    Draw,       // does nothing but draw
    Begin,      // glBegin…
    End,        // …and glEnd
    Vertex,     // draws between them
    Attribute,  // current values, allowed between them
    Clear,      // glClear
    Reads,      // takes pixels out of the framebuffer that is read
    CallsLists, // may draw and change state
};
Role roleOf(uint16_t opcode);

} // namespace mural::recording
