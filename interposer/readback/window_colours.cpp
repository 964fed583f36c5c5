#include "interposer/readback/window_colours.hpp"

#include <GL/glext.h>
#include <cstring>

#include "interposer/context/context.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

constexpr ColourReads kBytes{GL_UNSIGNED_BYTE, 4, 0};
constexpr ColourReads kTenBits{GL_UNSIGNED_INT_2_10_10_10_REV, 4, wire::kTenBits};
constexpr ColourReads kFloats{GL_FLOAT, 16, wire::kFloats};

// Component k of a pixel, and the distance of two values, for each type.
struct Bytes {
    using Component = uint8_t;
    static Component at(const void* colours, size_t pixel, size_t k) {
        return static_cast<const uint8_t*>(colours)[4 * pixel + k];
    }
    static uint32_t apart(Component a, Component b, size_t) { return static_cast<uint32_t>(a < b ? b - a : a - b); }
    static uint8_t byte(Component a, size_t) { return a; }
};

struct TenBits {
    using Component = uint32_t;
    static uint32_t largest(size_t k) { return k == 3 ? 3 : 1023; }
    static Component at(const void* colours, size_t pixel, size_t k) {
        uint32_t word = 0;
        std::memcpy(&word, static_cast<const uint8_t*>(colours) + 4 * pixel, 4);
        return word >> (10 * k) & largest(k);
    }
    static uint32_t apart(Component a, Component b, size_t k) {
        return ((a < b ? b - a : a - b) * 255 + largest(k) - 1) / largest(k);
    }
    static uint8_t byte(Component a, size_t k) {
        return static_cast<uint8_t>((2 * a * 255 + largest(k)) / (2 * largest(k)));
    }
};

struct Floats {
    using Component = float;
    static Component at(const void* colours, size_t pixel, size_t k) {
        float value = 0;
        std::memcpy(&value, static_cast<const uint8_t*>(colours) + 16 * pixel + 4 * k, 4);
        return value;
    }
    static uint32_t apart(Component a, Component b, size_t) {
        constexpr float kMax = 1 << 16; // largest half float
        // NaN with equal bits is equal. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
        if (std::memcmp(&a, &b, sizeof a) == 0 || a == b) return 0;
        const float distance = a < b ? b - a : a - b;
        const float parts = (distance < kMax ? distance : kMax) * 255; // NaN gives kMax
        const auto whole = static_cast<uint32_t>(parts);
        return parts > static_cast<float>(whole) ? whole + 1 : whole;
    }
    static uint8_t byte(Component a, size_t) { return static_cast<uint8_t>((a > 0 ? a < 1 ? a : 1 : 0) * 255 + 0.5F); }
};

template <class Of> ColourDifference compareBy(const void* a, const void* b, size_t pixels) {
    ColourDifference difference;
    for (size_t i = 0; i < pixels; ++i) {
        uint32_t worst = 0;
        for (size_t k = 0; k < 4; ++k) {
            const uint32_t apart = Of::apart(Of::at(a, i, k), Of::at(b, i, k), k);
            worst = apart > worst ? apart : worst;
            difference.squared += uint64_t{apart} * apart;
        }
        difference.differingPixels += worst > 0;
        difference.largest = worst > difference.largest ? worst : difference.largest;
    }
    return difference;
}

template <class Of> void reduceBy(void* colours, size_t pixels) {
    for (size_t i = 0; i < pixels; ++i) {
        uint8_t bytes[4];
        for (size_t k = 0; k < 4; ++k) bytes[k] = Of::byte(Of::at(colours, i, k), k);
        std::memcpy(static_cast<uint8_t*>(colours) + 4 * i, bytes, 4);
    }
}

} // namespace

ColourReads colourReadsOf(const Context& context, const Window& window) {
    const uint8_t bits = window.config.red;
    const bool reads = context.api == wire::Api::Desktop || context.version >= 30;
    if (bits <= 8 || !reads) return kBytes;
    return bits <= 10 ? kTenBits : kFloats;
}

ColourDifference compareColours(const void* a, const void* b, size_t pixels, GLenum type) {
    switch (type) {
    case GL_UNSIGNED_INT_2_10_10_10_REV: return compareBy<TenBits>(a, b, pixels);
    case GL_FLOAT: return compareBy<Floats>(a, b, pixels);
    default: return compareBy<Bytes>(a, b, pixels);
    }
}

void reduceToBytes(void* colours, size_t pixels, GLenum type) {
    if (type == GL_UNSIGNED_INT_2_10_10_10_REV) reduceBy<TenBits>(colours, pixels);
    if (type == GL_FLOAT) reduceBy<Floats>(colours, pixels);
}

} // namespace mural
