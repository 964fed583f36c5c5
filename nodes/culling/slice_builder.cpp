#include "nodes/culling/slice_builder.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace mural::culling {

namespace {

// A shader with more operations is not sliced.
constexpr size_t kMaxNodes = 200'000;

size_t operandsOf(SliceOp op) {
    switch (op) {
    case SliceOp::Constant:
    case SliceOp::Uniform:
    case SliceOp::Input: return 0;
    case SliceOp::Negate:
    case SliceOp::Absolute:
    case SliceOp::SquareRoot:
    case SliceOp::Sine:
    case SliceOp::Cosine:
    case SliceOp::Not: return 1;
    case SliceOp::Select: return 3;
    default: return 2;
    }
}

double wholeResult(SliceOp op, double a, double b) {
    switch (op) {
    case SliceOp::Add: return a + b;
    case SliceOp::Subtract: return a - b;
    case SliceOp::Multiply: return a * b;
    case SliceOp::Negate: return -a;
    case SliceOp::Minimum: return std::min(a, b);
    case SliceOp::Maximum: return std::max(a, b);
    case SliceOp::Less: return a < b;
    case SliceOp::Equal: return a == b;
    case SliceOp::And: return a != 0 && b != 0;
    case SliceOp::Not: return a == 0;
    default: return 0;
    }
}

bool isWholeOp(SliceOp op) {
    return op != SliceOp::Divide && op != SliceOp::Absolute && op != SliceOp::SquareRoot && op != SliceOp::Sine &&
           op != SliceOp::Cosine;
}

} // namespace

uint32_t SliceBuilder::add(const SliceNode& node) {
    if (nodes_.size() >= kMaxNodes) return kUnknown;
    nodes_.push_back(node);
    return static_cast<uint32_t>(nodes_.size() - 1);
}

uint32_t SliceBuilder::constant(double value) { return add({SliceOp::Constant, 0, 0, 0, value}); }

uint32_t SliceBuilder::source(SliceOp op, const std::string& name, uint32_t component) {
    const auto [it, isNew] = sources_.try_emplace({name, component}, kUnknown);
    if (!isNew) return it->second;
    std::vector<SliceSource>& list = op == SliceOp::Uniform ? uniforms_ : inputs_;
    list.push_back({name, component});
    return it->second = add({op, static_cast<uint32_t>(list.size() - 1), 0, 0, 0});
}

const double* SliceBuilder::known(uint32_t node) const {
    return node != kUnknown && nodes_[node].op == SliceOp::Constant ? &nodes_[node].value : nullptr;
}

uint32_t SliceBuilder::make(SliceOp op, uint32_t a, uint32_t b, bool isWhole) {
    const size_t operands = operandsOf(op);
    if (a == kUnknown || (operands == 2 && b == kUnknown)) return kUnknown;
    const double *const left = known(a), *const right = operands == 2 ? known(b) : left;
    if (left && right && isWholeOp(op) && (isWhole || op == SliceOp::Negate))
        return constant(wholeResult(op, *left, *right));
    // Products with 0 and 1, and sums with 0, are frequent: vec4(position, 1).
    if (op == SliceOp::Multiply && ((left && *left == 1) || (right && *right == 1))) return left && *left == 1 ? b : a;
    if (op == SliceOp::Add && ((left && *left == 0) || (right && *right == 0))) return left && *left == 0 ? b : a;
    return add({op, a, operands == 2 ? b : 0, 0, 0});
}

uint32_t SliceBuilder::select(uint32_t condition, uint32_t a, uint32_t b) {
    if (a == b) return a;
    if (const double* const is = known(condition)) return *is != 0 ? a : b;
    if (condition == kUnknown || a == kUnknown || b == kUnknown) return kUnknown;
    if (nodes_[a] == nodes_[b]) return a;
    return add({SliceOp::Select, condition, a, b, 0});
}

SliceValue SliceBuilder::each(SliceOp op, const SliceValue& a, const SliceValue& b, bool isWhole) {
    const size_t size = std::max(a.size(), b.size());
    SliceValue result(size, kUnknown);
    if ((a.size() != size && a.size() != 1) || (b.size() != size && b.size() != 1)) return result;
    for (size_t i = 0; i < size; ++i) result[i] = make(op, a[a.size() == 1 ? 0 : i], b[b.size() == 1 ? 0 : i], isWhole);
    return result;
}

SliceValue SliceBuilder::eachOne(SliceOp op, const SliceValue& a, bool isWhole) {
    SliceValue result;
    for (const uint32_t scalar : a) result.push_back(make(op, scalar, scalar, isWhole));
    return result;
}

uint32_t SliceBuilder::dot(const SliceValue& a, const SliceValue& b) {
    if (a.size() != b.size() || a.empty()) return kUnknown;
    uint32_t sum = make(SliceOp::Multiply, a[0], b[0]);
    for (size_t i = 1; i < a.size(); ++i) sum = make(SliceOp::Add, sum, make(SliceOp::Multiply, a[i], b[i]));
    return sum;
}

SliceValue SliceBuilder::matrixTimesVector(const SliceValue& matrix, const SliceValue& vector, size_t rows) {
    SliceValue result;
    if (matrix.size() != rows * vector.size()) return SliceValue(rows, kUnknown);
    for (size_t row = 0; row < rows; ++row) {
        SliceValue across;
        for (size_t column = 0; column < vector.size(); ++column) across.push_back(matrix[column * rows + row]);
        result.push_back(dot(across, vector));
    }
    return result;
}

SliceValue SliceBuilder::vectorTimesMatrix(const SliceValue& vector, const SliceValue& matrix, size_t rows) {
    SliceValue result;
    for (size_t at = 0; rows > 0 && at + rows <= matrix.size(); at += rows)
        result.push_back(dot(vector, SliceValue(matrix.begin() + static_cast<ptrdiff_t>(at),
                                                matrix.begin() + static_cast<ptrdiff_t>(at + rows))));
    return result;
}

SliceValue SliceBuilder::matrixTimesMatrix(const SliceValue& a, const SliceValue& b, size_t rows, size_t inner) {
    SliceValue result;
    for (size_t at = 0; inner > 0 && at + inner <= b.size(); at += inner) {
        const SliceValue column(b.begin() + static_cast<ptrdiff_t>(at), b.begin() + static_cast<ptrdiff_t>(at + inner));
        const SliceValue product = matrixTimesVector(a, column, rows);
        result.insert(result.end(), product.begin(), product.end());
    }
    return result;
}

SliceValue SliceBuilder::select(uint32_t condition, const SliceValue& a, const SliceValue& b) {
    SliceValue result(std::max(a.size(), b.size()), kUnknown);
    if (a.size() == b.size())
        for (size_t i = 0; i < a.size(); ++i) result[i] = select(condition, a[i], b[i]);
    return result;
}

ShaderSlice SliceBuilder::finish(uint32_t x, uint32_t y, uint32_t w) const {
    ShaderSlice slice;
    if (x == kUnknown || y == kUnknown || w == kUnknown) {
        slice.reason = "the position depends on a value that no slice represents";
        return slice;
    }
    std::vector<bool> used(nodes_.size());
    for (const uint32_t root : {x, y, w}) used[root] = true;
    for (size_t i = nodes_.size(); i-- > 0;) {
        if (!used[i]) continue;
        const SliceNode& node = nodes_[i];
        const uint32_t operands[3] = {node.a, node.b, node.c};
        for (size_t k = 0; k < operandsOf(node.op); ++k) used[operands[k]] = true;
    }
    std::vector<uint32_t> numbers(nodes_.size());
    const auto sourceIn = [](std::vector<SliceSource>& list, const SliceSource& source) {
        list.push_back(source); // each source has one node
        return static_cast<uint32_t>(list.size() - 1);
    };
    for (size_t i = 0; i < nodes_.size(); ++i) {
        if (!used[i]) continue;
        SliceNode node = nodes_[i];
        const size_t operands = operandsOf(node.op);
        if (node.op == SliceOp::Uniform) node.a = sourceIn(slice.uniforms, uniforms_[node.a]);
        if (node.op == SliceOp::Input) node.a = sourceIn(slice.inputs, inputs_[node.a]);
        if (operands > 0) node.a = numbers[node.a];
        if (operands > 1) node.b = numbers[node.b];
        if (operands > 2) node.c = numbers[node.c];
        numbers[i] = static_cast<uint32_t>(slice.nodes.size());
        slice.nodes.push_back(node);
    }
    slice.x = numbers[x];
    slice.y = numbers[y];
    slice.w = numbers[w];
    return slice;
}

} // namespace mural::culling
