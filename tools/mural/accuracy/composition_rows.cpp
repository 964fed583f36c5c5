#include "tools/mural/accuracy/composition_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "common/base/clock.hpp"
#include "compositor/assembly/assembly.hpp"
#include "compositor/assembly/average.hpp"
#include "compositor/kernels/half_float.hpp"

namespace mural::cli {

using namespace compositor;

namespace {

constexpr int32_t kWidth = 509, kHeight = 383; // primes
constexpr size_t kPixels = size_t{kWidth} * kHeight;
const char* const kGroup = "Composition of synthetic pictures";

Image blank(PlaneFormat colour, uint32_t part) {
    Image image;
    image.colour.emplace(colour, kWidth, kHeight);
    image.drawn.add(image.area());
    image.order = {part, part + 1};
    return image;
}

template <class Value> Value valueAt(const Plane& plane, size_t index) {
    Value value{};
    std::memcpy(&value, plane.bytes().data() + index * sizeof value, sizeof value);
    return value;
}
template <class Value> void setValue(Plane& plane, size_t index, Value value) {
    std::memcpy(plane.bytes().data() + index * sizeof value, &value, sizeof value);
}

// Whole pixels of four bytes.
MeasuredError errorOfBytes(const Plane& wanted, const Plane& got) {
    MeasuredError error;
    for (size_t i = 0; i < wanted.bytes().size(); i += 4) {
        for (size_t c = 0; c < 4; ++c)
            error.addValue(std::to_integer<int>(got.bytes()[i + c]) - std::to_integer<int>(wanted.bytes()[i + c]));
        ++error.pixels;
        error.differing += std::memcmp(wanted.bytes().data() + i, got.bytes().data() + i, 4) != 0;
    }
    return error;
}

// Composites parts that arrive in another order than they are drawn. The reference is a depth test in draw order.
AccuracyRow depthRow(PlaneFormat format, DepthFunction function, const char* what) {
    constexpr uint32_t kParts = 8;
    std::mt19937 random(1);
    std::vector<Image> parts;
    for (uint32_t p = 0; p < kParts; ++p) {
        parts.push_back(blank(PlaneFormat::Rgba8, p));
        parts[p].depth.emplace(format, kWidth, kHeight);
        for (size_t i = 0; i < kPixels; ++i) {
            const uint32_t depth = random() % 50; // few values, so most pixels have equal depths
            setValue(*parts[p].colour, i, static_cast<uint32_t>(random()));
            if (format == PlaneFormat::D24S8)
                setValue(*parts[p].depth, i, depth << 20 | (static_cast<uint32_t>(random()) & 0xff));
            else
                setValue(*parts[p].depth, i, static_cast<float>(depth) / 50);
        }
    }
    Plane wanted(PlaneFormat::Rgba8, kWidth, kHeight);
    for (size_t i = 0; i < kPixels; ++i) {
        const auto depthOf = [&](uint32_t p) {
            return format == PlaneFormat::D24S8 ? static_cast<double>(valueAt<uint32_t>(*parts[p].depth, i) >> 8)
                                                : static_cast<double>(valueAt<float>(*parts[p].depth, i));
        };
        uint32_t best = 0;
        for (uint32_t p = 1; p < kParts; ++p) {
            const double later = depthOf(p), earlier = depthOf(best);
            if (function == DepthFunction::Less          ? later < earlier
                : function == DepthFunction::LessOrEqual ? later <= earlier
                                                         : later > earlier)
                best = p;
        }
        setValue(wanted, i, valueAt<uint32_t>(*parts[best].colour, i));
    }
    Image sum = parts[3];
    AccuracyRow row{kGroup, what, "depth test in draw order", {}, Bound::exact(), {}};
    for (const size_t next : {2, 4, 1, 0, 5, 6, 7})
        if (auto r = assembleDepth(sum, parts[next], {function, Coverage::All, 0}); !r) row.failure = r.error().message;
    row.error = errorOfBytes(wanted, *sum.colour);
    return row;
}

// Blends premultiplied layers; the reference is unrounded double precision.
AccuracyRow blendRow(PlaneFormat format, int layers, double bound, const char* what) {
    std::mt19937 random(2);
    Image sum = blank(format, 0);
    std::vector<double> truth(4 * kPixels, 0.0);
    AccuracyRow row{kGroup, what, "the same in double precision", {}, {{}, bound, {}}, {}};
    int64_t tookNs = 0;
    for (int layer = 0; layer < layers; ++layer) {
        Image front = blank(format, static_cast<uint32_t>(layer));
        for (size_t i = 0; i < kPixels; ++i) {
            const unsigned alpha = 26 + random() % 179; // 0.1 to 0.8
            std::array<double, 4> shown{};
            for (size_t c = 0; c < 4; ++c) {
                const unsigned value = c == 3 ? alpha : random() % (alpha + 1);
                double given = value / 255.0;
                if (format == PlaneFormat::Rgba8)
                    front.colour->bytes()[4 * i + c] = static_cast<std::byte>(value);
                else {
                    const uint16_t half = halfOfFloat(static_cast<float>(given));
                    setValue(*front.colour, 4 * i + c, half);
                    given = static_cast<double>(floatOfHalf(half)); // the rounded input, not the intended one
                }
                shown[c] = given;
            }
            for (size_t c = 0; c < 4; ++c) truth[4 * i + c] = shown[c] + truth[4 * i + c] * (1 - shown[3]);
        }
        const int64_t beganNs = threadCpuNowNs();
        if (layer == 0)
            sum = front;
        else if (auto r = assembleBlended(sum, front); !r)
            row.failure = r.error().message;
        tookNs += threadCpuNowNs() - beganNs;
    }
    row.cost = Cost{static_cast<double>(tookNs) / kPixels, static_cast<double>(bytesPerPixel(format)) * layers};
    for (size_t i = 0; i < 4 * kPixels; ++i) {
        const double got = format == PlaneFormat::Rgba8
                               ? std::to_integer<int>(sum.colour->bytes()[i])
                               : 255 * static_cast<double>(floatOfHalf(valueAt<uint16_t>(*sum.colour, i)));
        row.error.addValue(got - 255 * truth[i]);
        if (i % 4 == 0) ++row.error.pixels;
        if (i % 4 == 3) row.error.differing += std::abs(got - 255 * truth[i]) > 0;
    }
    return row;
}

AccuracyRow averageRow(unsigned samples, const char* what) {
    std::mt19937 random(3);
    Average average(PlaneFormat::Rgba8, kWidth, kHeight);
    std::vector<unsigned> sums(4 * kPixels, 0);
    AccuracyRow row{kGroup, what, "the mean, unrounded", {}, {{}, 0.5, {}}, {}};
    Plane picture(PlaneFormat::Rgba8, kWidth, kHeight);
    int64_t tookNs = 0;
    for (unsigned s = 0; s < samples; ++s) {
        for (size_t i = 0; i < sums.size(); ++i) {
            const auto value = static_cast<unsigned>(random() % 256);
            picture.bytes()[i] = static_cast<std::byte>(value);
            sums[i] += value;
        }
        const int64_t beganNs = threadCpuNowNs();
        if (auto r = average.add(std::as_const(picture).view()); !r) row.failure = r.error().message;
        tookNs += threadCpuNowNs() - beganNs;
    }
    const int64_t beganNs = threadCpuNowNs();
    if (auto r = average.write(picture.view()); !r) row.failure = r.error().message;
    row.cost = Cost{static_cast<double>(tookNs + threadCpuNowNs() - beganNs) / kPixels, 4.0 * samples};
    for (size_t i = 0; i < sums.size(); i += 4) {
        bool differs = false;
        for (size_t c = 0; c < 4; ++c) {
            const double d = std::to_integer<int>(picture.bytes()[i + c]) - static_cast<double>(sums[i + c]) / samples;
            row.error.addValue(d);
            differs = differs || d != 0;
        }
        ++row.error.pixels;
        row.error.differing += differs;
    }
    return row;
}

Plane noise(unsigned seed) {
    std::mt19937 random(seed);
    Plane plane(PlaneFormat::Rgba8, kWidth, kHeight);
    for (auto& b : plane.bytes()) b = static_cast<std::byte>(random());
    return plane;
}

AccuracyRow kernelRow() {
    const Plane wanted = noise(4);
    Plane got(PlaneFormat::Rgba8, kWidth, kHeight);
    AccuracyRow row{kGroup, "pixel: kernels of 3x2 interleaved", "the undivided picture", {}, Bound::exact(), {}};
    for (int32_t k = 0; k < 6; ++k) {
        const PixelKernel kernel{k % 3, k / 3, 3, 2};
        Plane part(PlaneFormat::Rgba8, (kWidth - kernel.x + 2) / 3, (kHeight - kernel.y + 1) / 2);
        for (int32_t y = 0; y < part.height(); ++y)
            for (int32_t x = 0; x < part.width(); ++x)
                std::memcpy(part.view().row(y) + 4 * x, wanted.view().row(kernel.y + 2 * y) + 4 * (kernel.x + 3 * x),
                            4);
        if (auto r = interleavePixels(got.view(), std::as_const(part).view(), kernel); !r)
            row.failure = r.error().message;
    }
    row.error = errorOfBytes(wanted, got);
    return row;
}

AccuracyRow anaglyphRow() {
    const Plane left = noise(5), right = noise(6);
    Plane wanted = right, got = right;
    for (size_t i = 0; i < wanted.bytes().size(); i += 4) wanted.bytes()[i] = left.bytes()[i];
    AccuracyRow row{kGroup, "stereo: colour masks of two eyes", "red of the left eye", {}, Bound::exact(), {}};
    if (auto r = assembleMasked(got.view(), left.view(), {true, false, false, false}); !r)
        row.failure = r.error().message;
    row.error = errorOfBytes(wanted, got);
    return row;
}

AccuracyRow tileRow() {
    const Plane wanted = noise(7);
    Image whole = blank(PlaneFormat::Rgba8, 0);
    AccuracyRow row{kGroup, "2D: 35 tiles of unequal size", "the undivided picture", {}, Bound::exact(), {}};
    for (int32_t t = 0; t < 35; ++t) {
        const int32_t x0 = kWidth * (t % 7) / 7, x1 = kWidth * (t % 7 + 1) / 7, y0 = kHeight * (t / 7) / 5,
                      y1 = kHeight * (t / 7 + 1) / 5;
        Image part;
        part.x = x0;
        part.y = y0;
        part.colour.emplace(PlaneFormat::Rgba8, x1 - x0, y1 - y0);
        for (int32_t y = y0; y < y1; ++y)
            std::memcpy(part.colour->view().row(y - y0), wanted.view().row(y) + 4 * x0,
                        static_cast<size_t>(x1 - x0) * 4);
        part.drawn.add({0, 0, x1 - x0, y1 - y0});
        if (auto r = assembleCopy(whole, part); !r) row.failure = r.error().message;
    }
    row.error = errorOfBytes(wanted, *whole.colour);
    return row;
}

} // namespace

void measureComposition(std::vector<AccuracyRow>& rows) {
    rows.push_back(tileRow());
    rows.push_back(depthRow(PlaneFormat::D24S8, DepthFunction::Less, "DB: 8 parts by depth, D24S8, GL_LESS, ties"));
    rows.push_back(
        depthRow(PlaneFormat::D24S8, DepthFunction::LessOrEqual, "DB: 8 parts by depth, D24S8, GL_LEQUAL, ties"));
    rows.push_back(depthRow(PlaneFormat::D32F, DepthFunction::Greater, "DB: 8 parts by depth, D32F, GL_GREATER, ties"));
    rows.push_back(blendRow(PlaneFormat::Rgba8, 8, 3, "ordered blending: 8 layers of RGBA8"));
    rows.push_back(blendRow(PlaneFormat::Rgba8, 32, 3, "ordered blending: 32 layers of RGBA8"));
    rows.push_back(blendRow(PlaneFormat::Rgba16F, 32, 1, "ordered blending: 32 layers of RGBA16F"));
    rows.push_back(averageRow(3, "subpixel: mean of 3"));
    rows.push_back(averageRow(16, "subpixel: mean of 16"));
    rows.push_back(averageRow(256, "subpixel: mean of 256"));
    rows.push_back(kernelRow());
    rows.push_back(anaglyphRow());
}

} // namespace mural::cli
