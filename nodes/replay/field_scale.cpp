#include "nodes/replay/field_scale.hpp"

#include <cmath>
#include <cstring>

namespace mural {

namespace {

template <class T> double scaleAt(const std::byte* from, bool transposed) {
    T values[16];
    std::memcpy(values, from, sizeof values);
    double m[16];
    for (size_t i = 0; i < 16; ++i) m[i] = static_cast<double>(transposed ? values[i % 4 * 4 + i / 4] : values[i]);
    return fieldScaleOf(m);
}

double projectionAt(const std::byte* from) {
    float m[16];
    std::memcpy(m, from, sizeof m);
    for (const int zero : {1, 2, 3, 4, 6, 7, 12, 13, 15})
        if (m[zero] != 0) return 0;
    if (std::fabs(m[11]) != 1 || m[0] == 0 || m[5] == 0 || m[14] == 0 || !std::isfinite(m[0])) return 0;
    return std::fabs(static_cast<double>(m[0]));
}

} // namespace

double fieldScaleOf(const double (&m)[16]) {
    for (const double value : m)
        if (!std::isfinite(value)) return 0;
    const double ww = m[3] * m[3] + m[7] * m[7] + m[11] * m[11];
    if (ww <= 1e-18) return 0;
    const double shear = (m[0] * m[3] + m[4] * m[7] + m[8] * m[11]) / ww; // what the first row has along the fourth
    const double x = m[0] - shear * m[3], y = m[4] - shear * m[7], z = m[8] - shear * m[11];
    const double scale = std::sqrt((x * x + y * y + z * z) / ww);
    return scale > 1e-9 ? scale : 0;
}

double fieldScaleOf(const float (&matrix)[16]) {
    double m[16];
    for (size_t i = 0; i < 16; ++i) m[i] = static_cast<double>(matrix[i]);
    return fieldScaleOf(m);
}

double fieldScaleAt(const std::byte* from, bool doubles, bool transposed) { return doubles ? scaleAt<double>(from, transposed) : scaleAt<float>(from, transposed); }

double lastProjectionIn(std::span<const std::byte> bytes) {
    double last = 0;
    for (size_t at = 0; at + 64 <= bytes.size(); at += 4) {
        const double scale = projectionAt(bytes.data() + at);
        if (scale != 0) last = scale;
    }
    return last;
}

} // namespace mural
