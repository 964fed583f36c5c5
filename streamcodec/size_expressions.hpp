// The functions of the size expressions in semantics.txt: the bytes at an input pointer, from the other parameters. The
// encoder uses them to copy, the replay to validate.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "streamcodec/sizes/evaluator_maps.hpp"
#include "streamcodec/sizes/parameter_counts.hpp"
#include "streamcodec/sizes/pixel_format.hpp"
#include "streamcodec/sizes/vertex_types.hpp"

namespace mural {

// count values of `bytes` each. A negative count is an error of the program: nothing is copied, and the driver reports
// it.
template <class N> constexpr uint64_t vn(N count, uint32_t bytes) {
    return static_cast<int64_t>(count) > 0 ? static_cast<uint64_t>(count) * bytes : 0;
}
// The same for pointers that may be null.
template <class P> bool given(const P& p) {
    if constexpr (requires { p.absent(); })
        return !p.absent();
    else
        return p != nullptr;
}
template <class N, class P> uint64_t n4(N count, const P& p) { return given(p) ? vn(count, 4) : 0; }
template <class N, class P> uint64_t n8(N count, const P& p) { return given(p) ? vn(count, 8) : 0; }
// One pixel of (format, type), or nothing.
template <class P> uint64_t clearBytes(GLenum format, GLenum type, const P& p) {
    return given(p) ? sizes::groupBytes(format, type) : 0;
}
// A text of `length` characters, or zero-terminated if negative. A length beyond every driver's limit is a program
// error, and the text may not exist.
template <class P> uint64_t labelBytes(const P& p, GLsizei length) {
    constexpr GLsizei kLongest = 1 << 16;
    if (!given(p) || length > kLongest) return 0;
    if (length >= 0) return static_cast<uint64_t>(length);
    if constexpr (requires { p.absent(); })
        return 0;
    else
        return std::strlen(p) + 1;
}
constexpr int clearValues(GLenum buffer) { return buffer == GL_COLOR ? 4 : 1; }
inline uint64_t saturated(uint64_t values, uint32_t bytes) {
    uint64_t product = 0;
    return __builtin_mul_overflow(values, bytes, &product) ? UINT64_MAX : product;
}
// The span of values that glMap1/2 read.
inline uint64_t mapSpan1(GLenum target, GLint stride, GLint order, uint32_t bytes) {
    return saturated(sizes::map1Values(target, stride, order), bytes);
}
inline uint64_t mapSpan2(GLenum target, GLint us, GLint uo, GLint vs, GLint vo, uint32_t bytes) {
    return saturated(sizes::map2Values(target, us, uo, vs, vo), bytes);
}

} // namespace mural
