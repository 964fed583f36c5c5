// Makes the nodes of a slice. Values of GLSL are lists of scalars: vectors by component, matrices by column, arrays and
// structures by element.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "nodes/culling/shader_slice.hpp"

namespace mural::culling {

// Node numbers. A scalar that no slice can represent is kUnknown.
using SliceValue = std::vector<uint32_t>;
inline constexpr uint32_t kUnknown = UINT32_MAX;

class SliceBuilder {
public:
    uint32_t constant(double value);
    uint32_t uniform(const std::string& name, uint32_t component) { return source(SliceOp::Uniform, name, component); }
    uint32_t input(const std::string& name, uint32_t component) { return source(SliceOp::Input, name, component); }
    // isWhole: on integers and booleans, whose results are exact.
    uint32_t make(SliceOp op, uint32_t a, uint32_t b, bool isWhole = false);
    uint32_t select(uint32_t condition, uint32_t a, uint32_t b);

    // Component by component. A single scalar applies to all components of the other value.
    SliceValue each(SliceOp op, const SliceValue& a, const SliceValue& b, bool isWhole = false);
    SliceValue eachOne(SliceOp op, const SliceValue& a, bool isWhole = false);
    uint32_t dot(const SliceValue& a, const SliceValue& b);
    // columns of `rows` scalars, times a column; and a row times columns.
    SliceValue matrixTimesVector(const SliceValue& matrix, const SliceValue& vector, size_t rows);
    SliceValue vectorTimesMatrix(const SliceValue& vector, const SliceValue& matrix, size_t rows);
    SliceValue matrixTimesMatrix(const SliceValue& a, const SliceValue& b, size_t rows, size_t inner);
    SliceValue select(uint32_t condition, const SliceValue& a, const SliceValue& b);

    // The constant value of a node; null: it has none.
    [[nodiscard]] const double* known(uint32_t node) const;
    // The slice of the nodes on which the position depends. Its reason names an unknown scalar.
    [[nodiscard]] ShaderSlice finish(uint32_t x, uint32_t y, uint32_t w) const;

private:
    uint32_t source(SliceOp op, const std::string& name, uint32_t component);
    uint32_t add(const SliceNode& node);

    std::vector<SliceNode> nodes_;
    std::vector<SliceSource> uniforms_, inputs_;
    std::map<std::pair<std::string, uint32_t>, uint32_t> sources_;
};

} // namespace mural::culling
