// The linear view of a slice for given uniforms.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "nodes/culling/linear_view.hpp"
#include "nodes/culling/shader_slice.hpp"

namespace mural::culling {

class SliceView {
public:
    // The slice must be usable, with at most kMaxInputs inputs.
    explicit SliceView(ShaderSlice slice);

    [[nodiscard]] const ShaderSlice& slice() const { return slice_; }
    // uniforms: values in the order of the slice's uniforms. Returns nothing if the position is not linear in the
    // inputs, or depends on a condition or a division that rounding may change.
    [[nodiscard]] std::optional<LinearView> viewFor(std::span<const float> uniforms);

private:
    // A number of the driver: it differs from `value` by at most `error`. magnitude: of all operands that entered.
    struct Number {
        double value = 0, magnitude = 0, error = 0;
    };
    bool evaluate(const SliceNode& node, size_t index, std::span<const float> uniforms);
    bool evaluateLinear(const SliceNode& node, size_t index);
    static bool combine(SliceOp op, const Number& a, const Number& b, Number& out);
    [[nodiscard]] LinearForm formOf(uint32_t node) const;
    [[nodiscard]] Number* linearAt(uint32_t node) { return linear_.data() + places_[node] * width_; }
    [[nodiscard]] const Number* linearAt(uint32_t node) const { return linear_.data() + places_[node] * width_; }

    ShaderSlice slice_;
    size_t width_;                // numbers of a linear node: one per input, and the constant
    std::vector<bool> isLinear_;  // depends on inputs
    std::vector<size_t> places_;  // of linear nodes
    std::vector<Number> numbers_; // of the other nodes
    std::vector<Number> linear_;
};

} // namespace mural::culling
