// The registry's commands as data: how to call each, and what its arguments may be. Filled by emit_tables.py.
#pragma once

#include <cstdint>
#include <span>

namespace fuzz {

union Value {
    std::uint64_t whole;
    double real;
    float single;
    void* pointer;
};

// Calls `function` with arguments of the right types, gives what it returns.
using Invoke = std::uint64_t (*)(void* function, const Value* arguments);

enum class Kind : std::uint8_t { // of objects
    Nothing,
    Texture,
    Buffer,
    Framebuffer,
    Renderbuffer,
    VertexArray,
    Query,
    Sampler,
    Program,
    Shader,
    Pipeline,
    TransformFeedback,
    ArbProgram,
    List,
    Count
};

enum class Draw : std::uint8_t { // where a value comes from
    Enum,       // one of a group
    Bits,       // some of a group
    Number,     // between low and high
    Real,       // around 0, sometimes large
    Boolean,
    Object,     // a name of that kind
    Sync,
    Input,      // memory with values of the type
    Text,       // a string that ends with 0
    Names,      // an array of names of that kind
    Enums,      // an array of values of the group
    Made,       // an array into which names of that kind are put
    Unpack,     // an image that is read: memory or an offset
    Pack,       // an image that is written: memory or an offset
    Array,      // vertices: memory or an offset
    Indices,    // of elements: memory or an offset
    Output      // memory that is written
};

enum class Type : std::uint8_t { Signed, Unsigned, Single, Double, Pointer, Byte, Short, Int, Float, Wide };

struct Param {
    const char* name;
    Draw draw;
    Type type; // of the value; of a pointer: of what it points to
    Kind kind;
    std::uint16_t group;
    std::int32_t low, high;
};

struct Command {
    const char* name;
    Invoke invoke;
    const Param* params;
    std::uint8_t paramCount;
    std::uint8_t gl, es1, es2;    // first version, times 10; 0: none
    bool removed;                 // from the core profile
    bool returns;
    Kind made;                    // what the returned name names
    const char* extensions;       // between blanks, for instance " GL_EXT_a GL_EXT_b "
    std::uint16_t family;         // commands that differ in types only
};

extern const std::span<const Command> kCommands;
extern const std::span<const std::span<const std::uint32_t>> kGroups; // group 0: all values
extern const std::uint16_t kFamilies;
extern const std::span<const std::uint32_t> kQueries; // all that glGet* may be asked for

} // namespace fuzz
