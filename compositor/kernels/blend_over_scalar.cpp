// Blending pixel by pixel: the reference for the vector code of blend_over.cpp.
#include <algorithm>
#include <cstring>

#include "compositor/kernels/blend_over.hpp"
#include "compositor/kernels/half_float.hpp"

namespace mural::compositor {

namespace {

template <class T> T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}
template <class T> void store(std::byte* at, T value) { std::memcpy(at, &value, sizeof value); }

// `whole`: alpha value for 1; `maximum`: maximum of the component.
uint32_t over(uint32_t front, uint32_t back, uint32_t alpha, uint32_t whole, uint32_t maximum) {
    return std::min(front + (2 * back * (whole - alpha) + whole) / (2 * whole), maximum);
}

void over8(std::byte* into, const std::byte* front, const std::byte* back) {
    const auto alpha = std::to_integer<uint32_t>(front[3]);
    for (int c = 0; c < 4; ++c)
        into[c] = static_cast<std::byte>(
            over(std::to_integer<uint32_t>(front[c]), std::to_integer<uint32_t>(back[c]), alpha, 255, 255));
}

void over10(std::byte* into, const std::byte* front, const std::byte* back) {
    const auto f = load<uint32_t>(front), b = load<uint32_t>(back);
    const uint32_t alpha = f >> 30;
    uint32_t result = over(alpha, b >> 30, alpha, 3, 3) << 30;
    for (int shift = 0; shift < 30; shift += 10)
        result |= over(f >> shift & 1023, b >> shift & 1023, alpha, 3, 1023) << shift;
    store(into, result);
}

void over16(std::byte* into, const std::byte* front, const std::byte* back) {
    const float left = 1.0f - floatOfHalf(load<uint16_t>(front + 6));
    for (int c = 0; c < 8; c += 2) {
        const float covered = floatOfHalf(load<uint16_t>(back + c)) * left;
        store(into + c, halfOfFloat(floatOfHalf(load<uint16_t>(front + c)) + covered));
    }
}

void over32(std::byte* into, const std::byte* front, const std::byte* back) {
    const float left = 1.0f - load<float>(front + 12);
    for (int c = 0; c < 16; c += 4) {
        const float covered = load<float>(back + c) * left;
        store(into + c, load<float>(front + c) + covered);
    }
}

} // namespace

void blendOverRowScalar(PlaneFormat format, std::byte* pixels, const std::byte* source, size_t count, SourceSide side) {
    const size_t step = bytesPerPixel(format);
    const auto one = format == PlaneFormat::Rgba8     ? over8
                     : format == PlaneFormat::Rgb10A2 ? over10
                     : format == PlaneFormat::Rgba16F ? over16
                                                      : over32;
    for (size_t i = 0; i < count; ++i, pixels += step, source += step) {
        if (side == SourceSide::InFront)
            one(pixels, source, pixels);
        else
            one(pixels, pixels, source);
    }
}

} // namespace mural::compositor
