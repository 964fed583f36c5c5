// The registry's commands as data: their functions and the permitted arguments. emit_tables.py fills them.
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

// Calls `function` with arguments of the right types. Returns the function's result.
using Invoke = std::uint64_t (*)(void* function, const Value* arguments);

enum class Kind : std::uint8_t { // kind of object
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

enum class Draw : std::uint8_t { // source of a value
    Enum,                        // one of a group
    Bits,                        // some of a group
    Number,                      // between low and high
    Real,                        // around 0, sometimes large
    Boolean,
    Object, // a name of that kind
    Sync,
    Input,   // memory with values of the type
    Text,    // a string that ends with 0
    Names,   // an array of names of that kind
    Enums,   // an array of values of the group
    Made,    // an array that receives names of that kind
    Unpack,  // an image that is read: memory or an offset
    Pack,    // an image that is written: memory or an offset
    Array,   // vertices: memory or an offset
    Indices, // of elements: memory or an offset
    Output   // memory that is written
};

enum class Type : std::uint8_t { Signed, Unsigned, Single, Double, Pointer, Byte, Short, Int, Float, Wide };

struct Param {
    const char* name;
    Draw draw;
    Type type; // of the value; for a pointer: of its target
    Kind kind;
    std::uint16_t group;
    std::int32_t low, high;
};

struct Command {
    const char* name;
    Invoke invoke;
    const Param* params;
    std::uint8_t paramCount;
    std::uint8_t gl, es1, es2; // first version, times 10; 0: none
    bool removed;              // removed from the core profile
    bool returns;
    Kind made;              // kind of the returned name
    const char* extensions; // separated by blanks, for example " GL_EXT_a GL_EXT_b "
    std::uint16_t family;   // common to commands that differ only in types
};

extern const std::span<const Command> kCommands;
extern const std::span<const std::span<const std::uint32_t>> kGroups; // group 0: all values
extern const std::uint16_t kFamilies;
extern const std::span<const std::uint32_t> kQueries; // all queries of glGet*

} // namespace fuzz
