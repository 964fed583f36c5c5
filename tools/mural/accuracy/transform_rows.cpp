#include "tools/mural/accuracy/transform_rows.hpp"

#include <cmath>

#include "balancer/compound/frusta.hpp"
#include "common/base/clock.hpp"

namespace mural::cli {

namespace {

constexpr int kPictureWidth = 1021, kPictureHeight = 767, kColumns = 7, kRows = 5; // tiles that do not divide the size
const Frustum kWhole{-0.83, 0.91, -0.47, 0.52, 0.1, 100};

// A synthetic picture as a function of the position: waves that change by up to a sixth of full brightness per pixel,
// and edges.
template <class Real> double brightness(Real x, Real y) {
    const double wave = 0.5 + 0.5 * std::sin(static_cast<double>(x) * 420) * std::cos(static_cast<double>(y) * 310);
    return std::fmod(std::floor(static_cast<double>(x) * 9 + static_cast<double>(y) * 5) + 1000, 2) == 0 ? wave
                                                                                                         : 1 - wave;
}

// Returns the position of pixel i's centre in a part, as shaders interpolate it.
template <class Real> Real placeOf(double first, double last, int i, int pixels) {
    return static_cast<Real>(first) +
           (static_cast<Real>(i) + static_cast<Real>(0.5)) *
               ((static_cast<Real>(last) - static_cast<Real>(first)) / static_cast<Real>(pixels));
}

template <class Real> AccuracyRow transformRow(const char* what, const Bound& bound) {
    AccuracyRow row{"Positions of pixel lookups", what, "undivided, 64-bit mantissa", {}, bound, {}, {}};
    int64_t tookNs = 0;
    std::vector<Real> xs, ys;
    for (int t = 0; t < kColumns * kRows; ++t) {
        const int x0 = kPictureWidth * (t % kColumns) / kColumns, x1 = kPictureWidth * (t % kColumns + 1) / kColumns,
                  y0 = kPictureHeight * (t / kColumns) / kRows, y1 = kPictureHeight * (t / kColumns + 1) / kRows;
        const int64_t beganNs = threadCpuNowNs();
        const Frustum f = compound::partOf(kWhole, {1. * x0 / kPictureWidth, 1. * y0 / kPictureHeight,
                                                    1. * (x1 - x0) / kPictureWidth, 1. * (y1 - y0) / kPictureHeight});
        xs.clear();
        ys.clear();
        for (int y = 0; y < y1 - y0; ++y)
            for (int x = 0; x < x1 - x0; ++x) {
                xs.push_back(placeOf<Real>(f.left, f.right, x, x1 - x0));
                ys.push_back(placeOf<Real>(f.bottom, f.top, y, y1 - y0));
            }
        tookNs += threadCpuNowNs() - beganNs;
        size_t i = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x, ++i) {
                const double wanted =
                    std::round(255 * brightness(placeOf<long double>(kWhole.left, kWhole.right, x, kPictureWidth),
                                                placeOf<long double>(kWhole.bottom, kWhole.top, y, kPictureHeight)));
                const double d = std::round(255 * brightness(xs[i], ys[i])) - wanted;
                row.error.addValue(d);
                ++row.error.pixels;
                row.error.differing += d != 0;
            }
    }
    row.cost = Cost{static_cast<double>(tookNs) / (kPictureWidth * kPictureHeight), 2 * sizeof(Real)};
    return row;
}

} // namespace

void measureTransforms(std::vector<AccuracyRow>& rows) {
    // An edge at a pixel's centre may fall on either side. The error then is its full brightness, in a few of 783 107
    // pixels.
    rows.push_back(transformRow<float>("35 tiles, single precision", {0.001, {}, 60.0}));
    rows.push_back(transformRow<double>("35 tiles, double precision", {0.00001, {}, 80.0}));
}

} // namespace mural::cli
