#include "nodes/culling/vertex_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <GL/gl.h>
#include <GL/glext.h>

namespace mural::culling {

namespace {

// Draws below this number of clusters are decided as a whole.
constexpr uint64_t kMinClusters = 2;

struct Bounds {
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -std::numeric_limits<float>::infinity();
};

template <class T> T loadAt(const std::byte* from) {
    T value{};
    std::memcpy(&value, from, sizeof value);
    return value;
}

// The float that is not above, or not below, `value`.
float roundedDown(double value) {
    const auto rounded = static_cast<float>(value);
    return double{rounded} > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}
float roundedUp(double value) { return -roundedDown(-value); }

double halfToDouble(uint16_t bits) {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double sign = bits & 0x8000 ? -1 : 1;
    if (exponent == 31) return std::numeric_limits<double>::quiet_NaN(); // infinity has no box either
    return sign * (exponent ? std::ldexp(1024 + fraction, exponent - 25) : std::ldexp(fraction, -24));
}

struct HalfFloat {
    uint16_t bits;
};
struct FixedPoint {
    int32_t bits;
};

template <class T> double valueOf(T value) {
    if constexpr (std::is_same_v<T, HalfFloat>)
        return halfToDouble(value.bits);
    else if constexpr (std::is_same_v<T, FixedPoint>)
        return value.bits / 65536.0;
    else
        return static_cast<double>(value);
}

uint32_t componentBytes(uint32_t type) {
    switch (type) {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE: return 1;
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_HALF_FLOAT: return 2;
    case GL_INT:
    case GL_UNSIGNED_INT:
    case GL_FLOAT:
    case GL_FIXED: return 4;
    case GL_DOUBLE: return 8;
    default: return 0;
    }
}

// Calls `visit` with the number of each vertex of [from, to). Returns false if one is outside of `limit` vertices.
template <class Index, class Visit>
bool visitIndices(const VertexSequence& vertices, uint64_t from, uint64_t to, uint64_t limit, Visit&& visit) {
    const std::byte* at = vertices.indices.data() + from * sizeof(Index);
    for (uint64_t i = from; i < to; ++i, at += sizeof(Index)) {
        const Index index = loadAt<Index>(at);
        if (vertices.restart && index == *vertices.restart) continue;
        const int64_t vertex = vertices.first + int64_t{index};
        if (vertex < 0 || static_cast<uint64_t>(vertex) >= limit) return false;
        visit(static_cast<uint64_t>(vertex));
    }
    return true;
}

template <class Visit>
bool visitVertices(const VertexSequence& vertices, uint64_t from, uint64_t to, uint64_t limit, Visit&& visit) {
    switch (vertices.indexBytes) {
    case 1: return visitIndices<uint8_t>(vertices, from, to, limit, visit);
    case 2: return visitIndices<uint16_t>(vertices, from, to, limit, visit);
    case 4: return visitIndices<uint32_t>(vertices, from, to, limit, visit);
    default: break;
    }
    const int64_t first = vertices.first + static_cast<int64_t>(from);
    if (first < 0 || static_cast<uint64_t>(first) + (to - from) > limit) return false;
    for (uint64_t i = from; i < to; ++i) visit(static_cast<uint64_t>(vertices.first) + i);
    return true;
}

// Bounds of each component over the vertices [from, to).
template <class T>
bool boundsOf(const AttributeArray& array, const VertexSequence& vertices, uint64_t from, uint64_t to, Bounds* out) {
    const uint64_t element = elementBytes(array);
    const uint64_t limit = array.bytes.size() < element ? 0 : (array.bytes.size() - element) / array.strideBytes + 1;
    double lowest[4], highest[4];
    std::fill_n(lowest, 4, std::numeric_limits<double>::infinity());
    std::fill_n(highest, 4, -std::numeric_limits<double>::infinity());
    bool isFinite = true;
    const bool inside = visitVertices(vertices, from, to, limit, [&](uint64_t vertex) {
        const std::byte* const at = array.bytes.data() + vertex * array.strideBytes;
        for (uint32_t c = 0; c < array.components; ++c) {
            const double value = valueOf(loadAt<T>(at + c * sizeof(T)));
            isFinite = isFinite && std::abs(value) <= std::numeric_limits<float>::max();
            lowest[c] = value < lowest[c] ? value : lowest[c];
            highest[c] = value > highest[c] ? value : highest[c];
        }
    });
    for (uint32_t c = 0; c < array.components; ++c) out[c] = {roundedDown(lowest[c]), roundedUp(highest[c])};
    return inside && isFinite;
}

// Floats are exact, and by far the most frequent.
template <>
bool boundsOf<float>(const AttributeArray& array, const VertexSequence& vertices, uint64_t from, uint64_t to,
                     Bounds* out) {
    const uint64_t element = elementBytes(array);
    const uint64_t limit = array.bytes.size() < element ? 0 : (array.bytes.size() - element) / array.strideBytes + 1;
    Bounds bounds[4];
    float nan = 0;
    const bool inside = visitVertices(vertices, from, to, limit, [&](uint64_t vertex) {
        const std::byte* const at = array.bytes.data() + vertex * array.strideBytes;
        for (uint32_t c = 0; c < array.components; ++c) {
            const auto value = loadAt<float>(at + c * sizeof(float));
            nan += value * 0; // NaN for NaN and infinity
            bounds[c].lowest = value < bounds[c].lowest ? value : bounds[c].lowest;
            bounds[c].highest = value > bounds[c].highest ? value : bounds[c].highest;
        }
    });
    std::copy_n(bounds, array.components, out);
    return inside && nan == 0;
}

// The range of a normalized integer. Versions of GL convert signed ones by two formulas, and the bounds hold for both.
void normalize(const AttributeArray& array, Bounds& bounds) {
    const bool isSigned = array.type == GL_BYTE || array.type == GL_SHORT || array.type == GL_INT;
    const double bits = 8.0 * componentBytes(array.type);
    const double greatest = std::exp2(isSigned ? bits - 1 : bits) - 1;
    const auto convert = [&](double value, bool up) {
        const double direct = isSigned ? std::max(value / greatest, -1.0) : value / greatest;
        const double centred = isSigned ? (2 * value + 1) / (2 * greatest + 1) : direct;
        return up ? roundedUp(std::max(direct, centred)) : roundedDown(std::min(direct, centred));
    };
    bounds = {convert(bounds.lowest, false), convert(bounds.highest, true)};
}

bool boundsOfArray(const AttributeArray& array, const VertexSequence& vertices, uint64_t from, uint64_t to,
                   Bounds* out) {
    bool isBounded = false;
    switch (array.type) {
    case GL_FLOAT: return boundsOf<float>(array, vertices, from, to, out);
    case GL_DOUBLE: return boundsOf<double>(array, vertices, from, to, out);
    case GL_HALF_FLOAT: return boundsOf<HalfFloat>(array, vertices, from, to, out);
    case GL_FIXED: return boundsOf<FixedPoint>(array, vertices, from, to, out);
    case GL_BYTE: isBounded = boundsOf<int8_t>(array, vertices, from, to, out); break;
    case GL_UNSIGNED_BYTE: isBounded = boundsOf<uint8_t>(array, vertices, from, to, out); break;
    case GL_SHORT: isBounded = boundsOf<int16_t>(array, vertices, from, to, out); break;
    case GL_UNSIGNED_SHORT: isBounded = boundsOf<uint16_t>(array, vertices, from, to, out); break;
    case GL_INT: isBounded = boundsOf<int32_t>(array, vertices, from, to, out); break;
    case GL_UNSIGNED_INT: isBounded = boundsOf<uint32_t>(array, vertices, from, to, out); break;
    default: return false;
    }
    for (uint32_t c = 0; array.isNormalized && c < array.components; ++c) normalize(array, out[c]);
    return isBounded;
}

// Appends the box of the vertices [from, to). An empty box, of restart indices only, becomes a point.
bool appendBox(std::span<const AttributeArray> arrays, const VertexSequence& vertices, uint64_t from, uint64_t to,
               size_t inputs, std::vector<float>& out) {
    Bounds bounds[kMaxInputs];
    size_t input = 0;
    for (const AttributeArray& array : arrays) {
        if (!boundsOfArray(array, vertices, from, to, bounds + input)) return false;
        input += array.components;
    }
    for (size_t i = 0; i < inputs; ++i)
        if (bounds[i].lowest > bounds[i].highest) bounds[i] = {0, 0};
    for (size_t i = 0; i < inputs; ++i) out.push_back(bounds[i].lowest);
    for (size_t i = 0; i < inputs; ++i) out.push_back(bounds[i].highest);
    return true;
}

// Unites `group` boxes into one each.
std::vector<float> unitedBoxes(const std::vector<float>& boxes, size_t inputs, size_t group) {
    std::vector<float> out;
    const size_t each = 2 * inputs, count = boxes.size() / each;
    for (size_t from = 0; from < count; from += group) {
        const size_t at = out.size();
        out.insert(out.end(), boxes.begin() + static_cast<ptrdiff_t>(from * each),
                   boxes.begin() + static_cast<ptrdiff_t>((from + 1) * each));
        for (size_t box = from + 1; box < std::min(from + group, count); ++box)
            for (size_t i = 0; i < inputs; ++i) {
                out[at + i] = std::min(out[at + i], boxes[box * each + i]);
                out[at + inputs + i] = std::max(out[at + inputs + i], boxes[box * each + inputs + i]);
            }
    }
    return out;
}

} // namespace

uint32_t elementBytes(const AttributeArray& array) { return componentBytes(array.type) * array.components; }

PrimitiveForm formOf(uint32_t mode) {
    switch (mode) {
    case GL_POINTS: return {1, 0};
    case GL_LINES: return {2, 0};
    case GL_TRIANGLES: return {3, 0};
    case GL_LINE_STRIP: return {1, 1};
    case GL_TRIANGLE_STRIP: return {1, 2};
    default: return {};
    }
}

DrawBoxes::DrawBoxes(size_t inputs, const std::vector<float>& whole, std::vector<Level> levels)
    : inputs_(inputs), levels_(std::move(levels)) {
    std::copy_n(whole.begin(), std::min(whole.size(), whole_.size()), whole_.begin());
}

size_t DrawBoxes::memoryBytes() const {
    size_t bytes = sizeof *this;
    for (const Level& level : levels_) bytes += sizeof level + level.bounds.capacity() * sizeof(float);
    return bytes;
}

std::optional<IndexBounds> indexBounds(const VertexSequence& vertices) {
    IndexBounds bounds{UINT32_MAX, 0};
    bool any = false;
    VertexSequence plain = vertices;
    plain.first = 0;
    visitVertices(plain, 0, plain.count, uint64_t{1} << 33, [&](uint64_t vertex) {
        const auto index = static_cast<uint32_t>(vertex);
        bounds.lowest = std::min(bounds.lowest, index);
        bounds.highest = std::max(bounds.highest, index);
        any = true;
    });
    return any ? std::optional(bounds) : std::nullopt;
}

std::optional<DrawBoxes> makeBoxes(std::span<const AttributeArray> arrays, const VertexSequence& vertices,
                                   PrimitiveForm form) {
    size_t inputs = 0;
    for (const AttributeArray& array : arrays) {
        if (elementBytes(array) == 0 || array.components > 4 || array.strideBytes == 0) return std::nullopt;
        inputs += array.components;
    }
    if (inputs == 0 || inputs > kMaxInputs || vertices.count == 0) return std::nullopt;
    if (vertices.indices.size() < vertices.count * vertices.indexBytes) return std::nullopt;
    const uint64_t step = uint64_t{form.step} * kClusterPrimitives[0];
    std::vector<DrawBoxes::Level> levels;
    if (step == 0 || vertices.count < kMinClusters * step) {
        std::vector<float> whole;
        if (!appendBox(arrays, vertices, 0, vertices.count, inputs, whole)) return std::nullopt;
        return DrawBoxes(inputs, whole, {});
    }
    levels.push_back({step, {}});
    for (uint64_t from = 0; from < vertices.count; from += step)
        if (!appendBox(arrays, vertices, from, std::min(from + step + form.overlap, vertices.count), inputs,
                       levels[0].bounds))
            return std::nullopt;
    for (size_t i = 1; i < kClusterLevels; ++i) {
        const size_t group = kClusterPrimitives[i] / kClusterPrimitives[i - 1];
        levels.push_back({levels.back().vertices * group, unitedBoxes(levels.back().bounds, inputs, group)});
    }
    const std::vector<float> whole = unitedBoxes(levels.back().bounds, inputs, SIZE_MAX);
    return DrawBoxes(inputs, whole, std::move(levels));
}

} // namespace mural::culling
