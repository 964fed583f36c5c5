#include "nodes/replay/features/accumulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace mural::accumulation {

namespace {

// The upper 20 bits of the smallest float that encodes to sRGB byte 1, 2, … 255. Measured: the driver does not always
// round to the nearest byte, and ignores lower bits.
constexpr std::array<uint32_t, 255> kEncodedFrom = {
    0x391ed, 0x39eed, 0x3a46f, 0x3a8b3, 0x3ab32, 0x3adae, 0x3b014, 0x3b153, 0x3b291, 0x3b3cf, 0x3b50d, 0x3b660, 0x3b7c4,
    0x3b89d, 0x3b963, 0x3ba31, 0x3bb09, 0x3bbed, 0x3bcdb, 0x3bdd4, 0x3bed6, 0x3bfe3, 0x3c07f, 0x3c10f, 0x3c1a7, 0x3c244,
    0x3c2e5, 0x3c38f, 0x3c43b, 0x3c4ee, 0x3c5a9, 0x3c668, 0x3c72e, 0x3c7f9, 0x3c866, 0x3c8d1, 0x3c941, 0x3c9b3, 0x3ca27,
    0x3caa0, 0x3cb1a, 0x3cb9a, 0x3cc1c, 0x3cca2, 0x3cd2a, 0x3cdb6, 0x3ce45, 0x3ced7, 0x3cf6e, 0x3d002, 0x3d052, 0x3d0a2,
    0x3d0f2, 0x3d147, 0x3d19d, 0x3d1f2, 0x3d24c, 0x3d2a7, 0x3d302, 0x3d362, 0x3d3c1, 0x3d423, 0x3d487, 0x3d4ec, 0x3d554,
    0x3d5bd, 0x3d628, 0x3d695, 0x3d703, 0x3d775, 0x3d7e7, 0x3d82e, 0x3d86a, 0x3d8a6, 0x3d8e2, 0x3d921, 0x3d961, 0x3d9a1,
    0x3d9e1, 0x3da23, 0x3da67, 0x3daab, 0x3daef, 0x3db36, 0x3db7d, 0x3dbc5, 0x3dc0d, 0x3dc59, 0x3dca4, 0x3dcef, 0x3dd3d,
    0x3dd8c, 0x3dddb, 0x3de2b, 0x3de7d, 0x3decf, 0x3df22, 0x3df78, 0x3dfcd, 0x3e011, 0x3e03e, 0x3e06b, 0x3e098, 0x3e0c5,
    0x3e0f2, 0x3e122, 0x3e152, 0x3e182, 0x3e1b2, 0x3e1e2, 0x3e213, 0x3e246, 0x3e279, 0x3e2ac, 0x3e2de, 0x3e313, 0x3e348,
    0x3e37e, 0x3e3b4, 0x3e3e9, 0x3e421, 0x3e459, 0x3e491, 0x3e4ca, 0x3e502, 0x3e53d, 0x3e578, 0x3e5b3, 0x3e5ee, 0x3e62b,
    0x3e668, 0x3e6a6, 0x3e6e3, 0x3e722, 0x3e762, 0x3e7a2, 0x3e7e2, 0x3e811, 0x3e833, 0x3e854, 0x3e876, 0x3e898, 0x3e8b9,
    0x3e8db, 0x3e8fd, 0x3e921, 0x3e945, 0x3e968, 0x3e98c, 0x3e9b0, 0x3e9d4, 0x3e9f8, 0x3ea1e, 0x3ea44, 0x3ea6b, 0x3ea91,
    0x3eab7, 0x3eadd, 0x3eb04, 0x3eb2c, 0x3eb54, 0x3eb7c, 0x3eba5, 0x3ebcd, 0x3ebf5, 0x3ec1f, 0x3ec49, 0x3ec73, 0x3ec9d,
    0x3ecc7, 0x3ecf2, 0x3ed1d, 0x3ed4a, 0x3ed76, 0x3eda2, 0x3edce, 0x3edfa, 0x3ee28, 0x3ee56, 0x3ee84, 0x3eeb2, 0x3eee0,
    0x3ef0f, 0x3ef3f, 0x3ef6f, 0x3ef9f, 0x3efcf, 0x3effe, 0x3f017, 0x3f031, 0x3f04a, 0x3f063, 0x3f07c, 0x3f096, 0x3f0af,
    0x3f0c8, 0x3f0e1, 0x3f0fb, 0x3f116, 0x3f130, 0x3f14b, 0x3f166, 0x3f181, 0x3f19c, 0x3f1b7, 0x3f1d2, 0x3f1ed, 0x3f209,
    0x3f225, 0x3f242, 0x3f25e, 0x3f27b, 0x3f298, 0x3f2b4, 0x3f2d1, 0x3f2ed, 0x3f30b, 0x3f329, 0x3f347, 0x3f365, 0x3f383,
    0x3f3a1, 0x3f3bf, 0x3f3de, 0x3f3fc, 0x3f41b, 0x3f43b, 0x3f45a, 0x3f47a, 0x3f49a, 0x3f4b9, 0x3f4d9, 0x3f4f9, 0x3f519,
    0x3f53a, 0x3f55b, 0x3f57d, 0x3f59e, 0x3f5bf, 0x3f5e0, 0x3f601, 0x3f624, 0x3f646, 0x3f669, 0x3f68b, 0x3f6ae, 0x3f6d0,
    0x3f6f3, 0x3f716, 0x3f73a, 0x3f75e, 0x3f782, 0x3f7a6, 0x3f7c9, 0x3f7ed,
};

constexpr float kOne = 32767.0f;

std::array<float, 256> decodeTable() {
    std::array<float, 256> table{};
    for (size_t i = 0; i < table.size(); ++i) {
        const double c = static_cast<double>(i) / 255.0;
        table[i] = static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return table;
}

// The x86 conversion: values outside the range of int become INT_MIN; then the lower half is taken.
int16_t toShort(float value) {
    const bool fits = value > -2147483648.0f && value < 2147483648.0f;
    return static_cast<int16_t>(fits ? static_cast<int32_t>(value) : INT32_MIN);
}

uint8_t encoded(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    uint32_t bits = 0;
    std::memcpy(&bits, &linear, 4);
    return static_cast<uint8_t>(std::upper_bound(kEncodedFrom.begin(), kEncodedFrom.end(), bits >> 12) -
                                kEncodedFrom.begin());
}

uint8_t rounded(float value) {
    if (!(value > 0)) return 0;
    return value >= 1 ? 255 : static_cast<uint8_t>(std::lrintf(value * 255.0f));
}

} // namespace

float decoded(uint8_t byte) {
    static const std::array<float, 256> kTable = decodeTable();
    return kTable[byte];
}

void load(int16_t* values, const uint8_t* rgba, size_t pixels, float by, bool add) {
    const float scale = by * kOne;
    for (size_t i = 0; i < pixels * 4; ++i) {
        const float colour = i % 4 == 3 ? static_cast<float>(rgba[i]) * (1.0f / 255.0f) : decoded(rgba[i]);
        const int16_t value = toShort(colour * scale);
        values[i] = add ? static_cast<int16_t>(values[i] + value) : value;
    }
}

void multiply(int16_t* values, size_t pixels, float by) {
    for (size_t i = 0; i < pixels * 4; ++i) values[i] = toShort(static_cast<float>(values[i]) * by);
}

void add(int16_t* values, size_t pixels, float what) {
    const int16_t value = toShort(what * kOne);
    for (size_t i = 0; i < pixels * 4; ++i) values[i] = static_cast<int16_t>(values[i] + value);
}

void clear(int16_t* values, size_t pixels, const float* colour) {
    int16_t value[4];
    for (int k = 0; k < 4; ++k) value[k] = static_cast<int16_t>((static_cast<int32_t>(65535.0f * colour[k]) - 1) / 2);
    for (size_t i = 0; i < pixels * 4; ++i) values[i] = value[i % 4];
}

void giveBack(const int16_t* values, uint8_t* rgba, size_t pixels, float by, const bool* channels) {
    const float scale = by / kOne;
    for (size_t i = 0; i < pixels * 4; ++i) {
        if (!channels[i % 4]) continue;
        const float value = static_cast<float>(values[i]) * scale;
        rgba[i] = i % 4 == 3 ? rounded(value) : encoded(value);
    }
}

} // namespace mural::accumulation
