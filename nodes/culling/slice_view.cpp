#include "nodes/culling/slice_view.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mural::culling {

namespace {
// Error of a driver's sine and cosine.
constexpr double kSineError = 1e-5;
} // namespace

SliceView::SliceView(ShaderSlice slice)
    : slice_(std::move(slice)),
      width_(slice_.inputs.size() + 1),
      isLinear_(slice_.nodes.size()),
      places_(slice_.nodes.size()),
      numbers_(slice_.nodes.size()) {
    size_t linear = 0;
    for (size_t i = 0; i < slice_.nodes.size(); ++i) {
        const SliceNode& node = slice_.nodes[i];
        switch (node.op) {
        case SliceOp::Constant:
        case SliceOp::Uniform: break;
        case SliceOp::Input: isLinear_[i] = true; break;
        case SliceOp::Select: isLinear_[i] = isLinear_[node.a] || isLinear_[node.b] || isLinear_[node.c]; break;
        // The second operand of operations with one operand is node 0, whose dependence does not matter.
        case SliceOp::Negate:
        case SliceOp::Absolute:
        case SliceOp::SquareRoot:
        case SliceOp::Sine:
        case SliceOp::Cosine:
        case SliceOp::Not: isLinear_[i] = isLinear_[node.a]; break;
        default: isLinear_[i] = isLinear_[node.a] || isLinear_[node.b];
        }
        if (isLinear_[i]) places_[i] = linear++;
    }
    linear_.resize(linear * width_);
}

bool SliceView::combine(SliceOp op, const Number& a, const Number& b, Number& out) {
    switch (op) {
    case SliceOp::Add:
    case SliceOp::Subtract:
        out = {op == SliceOp::Add ? a.value + b.value : a.value - b.value, a.magnitude + b.magnitude,
               a.error + b.error};
        out.error += kRounding * out.magnitude;
        return true;
    case SliceOp::Multiply:
        out = {a.value * b.value, a.magnitude * b.magnitude,
               a.magnitude * b.error + b.magnitude * a.error + a.error * b.error};
        out.error += kRounding * out.magnitude;
        return true;
    case SliceOp::Divide: {
        const double least = std::abs(b.value) - b.error;
        if (!(least > 0)) return false;
        out = {a.value / b.value, a.magnitude / least, 0};
        out.error = (a.error + std::abs(out.value) * b.error) / least + 2 * kRounding * out.magnitude;
        return true;
    }
    case SliceOp::Negate: out = {-a.value, a.magnitude, a.error}; return true;
    case SliceOp::Absolute: out = {std::abs(a.value), a.magnitude, a.error}; return true;
    case SliceOp::Minimum:
    case SliceOp::Maximum:
        out = {op == SliceOp::Minimum ? std::min(a.value, b.value) : std::max(a.value, b.value),
               std::max(a.magnitude, b.magnitude), std::max(a.error, b.error)};
        return a.value == a.value && b.value == b.value;
    case SliceOp::SquareRoot: {
        const double least = a.value - a.error;
        if (!(least > 0)) return false;
        const double root = std::sqrt(a.value);
        out = {root, root, a.error / std::sqrt(least) + 2 * kRounding * root};
        return true;
    }
    case SliceOp::Sine: out = {std::sin(a.value), 1, a.error + kSineError}; return true;
    case SliceOp::Cosine: out = {std::cos(a.value), 1, a.error + kSineError}; return true;
    case SliceOp::Less: {
        const bool isLess = a.value + a.error < b.value - b.error;
        const bool isNotLess = a.value - a.error >= b.value + b.error;
        out = {isLess ? 1.0 : 0.0, 1, 0};
        return isLess || isNotLess;
    }
    case SliceOp::Equal: {
        const bool isExact = a.error == 0 && b.error == 0;
        out = {isExact && a.value == b.value ? 1.0 : 0.0, 1, 0};
        return isExact || std::abs(a.value - b.value) > a.error + b.error;
    }
    case SliceOp::And: out = {a.value != 0 && b.value != 0 ? 1.0 : 0.0, 1, 0}; return true;
    case SliceOp::Not: out = {a.value == 0 ? 1.0 : 0.0, 1, 0}; return true;
    default: return false;
    }
}

bool SliceView::evaluateLinear(const SliceNode& node, size_t index) {
    Number* const out = linear_.data() + places_[index] * width_;
    if (node.op == SliceOp::Input) {
        std::fill_n(out, width_, Number{});
        out[node.a] = {1, 1, kRounding};
        return true;
    }
    if (node.op == SliceOp::Select) {
        if (isLinear_[node.a]) return false;
        const uint32_t chosen = numbers_[node.a].value != 0 ? node.b : node.c;
        std::fill_n(out, width_, Number{});
        if (isLinear_[chosen])
            std::copy_n(linearAt(chosen), width_, out);
        else
            out[width_ - 1] = numbers_[chosen];
        return true;
    }
    const bool isFirst = isLinear_[node.a];
    const Number* const a = isFirst ? linearAt(node.a) : nullptr;
    if (node.op == SliceOp::Negate) {
        for (size_t i = 0; i < width_; ++i) combine(SliceOp::Negate, a[i], a[i], out[i]);
        return true;
    }
    const bool isSum = node.op == SliceOp::Add || node.op == SliceOp::Subtract;
    const bool isProduct = node.op == SliceOp::Multiply || node.op == SliceOp::Divide;
    if (!isSum && !isProduct) return false;
    const bool isSecond = isLinear_[node.b];
    const Number* const b = isSecond ? linearAt(node.b) : nullptr;
    if (isSum) {
        for (size_t i = 0; i < width_; ++i) {
            const bool isLast = i + 1 == width_;
            combine(node.op,
                    a        ? a[i]
                    : isLast ? numbers_[node.a]
                             : Number{},
                    b        ? b[i]
                    : isLast ? numbers_[node.b]
                             : Number{},
                    out[i]);
        }
        return true;
    }
    if (a && b) return false;
    if (b) { // a constant times a linear function
        if (node.op == SliceOp::Divide) return false;
        for (size_t i = 0; i < width_; ++i) combine(SliceOp::Multiply, numbers_[node.a], b[i], out[i]);
        return true;
    }
    for (size_t i = 0; i < width_; ++i)
        if (!combine(node.op, a[i], numbers_[node.b], out[i])) return false;
    return true;
}

bool SliceView::evaluate(const SliceNode& node, size_t index, std::span<const float> uniforms) {
    Number& out = numbers_[index];
    switch (node.op) {
    case SliceOp::Constant: out = {node.value, std::abs(node.value), 0}; return true;
    case SliceOp::Uniform: {
        const double value = uniforms[node.a];
        out = {value, std::abs(value), 0};
        return true;
    }
    case SliceOp::Select: out = numbers_[numbers_[node.a].value != 0 ? node.b : node.c]; return true;
    default: return combine(node.op, numbers_[node.a], numbers_[node.b], out);
    }
}

LinearForm SliceView::formOf(uint32_t node) const {
    LinearForm form;
    if (!isLinear_[node]) {
        form.constant = numbers_[node].value;
        form.constantError = numbers_[node].error;
        return form;
    }
    const Number* const numbers = linearAt(node);
    for (size_t i = 0; i + 1 < width_; ++i) {
        form.factor[i] = numbers[i].value;
        form.error[i] = numbers[i].error;
    }
    form.constant = numbers[width_ - 1].value;
    form.constantError = numbers[width_ - 1].error;
    return form;
}

std::optional<LinearView> SliceView::viewFor(std::span<const float> uniforms) {
    if (slice_.inputs.size() > kMaxInputs || uniforms.size() < slice_.uniforms.size()) return std::nullopt;
    for (size_t i = 0; i < slice_.nodes.size(); ++i) {
        const SliceNode& node = slice_.nodes[i];
        if (!(isLinear_[i] ? evaluateLinear(node, i) : evaluate(node, i, uniforms))) return std::nullopt;
    }
    return LinearView{slice_.inputs.size(), formOf(slice_.x), formOf(slice_.y), formOf(slice_.w)};
}

} // namespace mural::culling
