// The part of a vertex shader that makes the position: scalar operations on uniforms and attributes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mural::culling {

enum class SliceOp : uint8_t {
    Constant, // value
    Uniform,  // a: index in `uniforms`
    Input,    // a: index in `inputs`
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    Minimum,
    Maximum,
    Absolute,
    SquareRoot,
    Sine,
    Cosine,
    // Results are 0 or 1.
    Less,
    Equal,
    And,
    Not,
    Select, // a ? b : c
};

struct SliceNode {
    SliceOp op = SliceOp::Constant;
    uint32_t a = 0, b = 0, c = 0; // operands: earlier nodes
    double value = 0;
    friend bool operator==(const SliceNode&, const SliceNode&) = default;
};

// One component of a uniform or an attribute. The name is GL's, such as "lights[2].matrix".
struct SliceSource {
    std::string name;
    uint32_t component = 0; // of a matrix: column by column
    friend bool operator==(const SliceSource&, const SliceSource&) = default;
};

struct ShaderSlice {
    std::vector<SliceNode> nodes; // operands come first
    std::vector<SliceSource> uniforms, inputs;
    uint32_t x = 0, y = 0, w = 0; // nodes
    std::string reason;           // why there is no slice; empty: there is one

    [[nodiscard]] bool isUsable() const { return reason.empty(); }
};

// Slices the text of a vertex shader: GLSL 1.10 to 4.60 and ES 1.00 to 3.20. Anything that the slice cannot represent,
// and on which the position depends, is a reason. isEs: of a context of OpenGL ES. Any thread, one at a time.
[[nodiscard]] ShaderSlice sliceOf(const std::string& text, bool isEs = false);

} // namespace mural::culling
