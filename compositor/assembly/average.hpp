// Average of n pictures (subpixel compounds, accumulated frames) from exact sums. For any n and order, an 8 or 10 bit
// component differs from the exact average by at most half a unit; ties round up. RGBA16F sums in single and RGBA32F in
// double precision; only their last bit depends on the order.
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/result.hpp"
#include "compositor/image/plane.hpp"

namespace mural::compositor {

class Average {
public:
    // Requires a colour format.
    Average(PlaneFormat format, int32_t width, int32_t height);

    // Errors: another shape; more pictures than the sums hold (kMaxAveraged8, kMaxAveraged10, 8192 for floats).
    [[nodiscard]] Result<void> add(const PlaneView& picture);
    // Errors: another shape; no pictures.
    [[nodiscard]] Result<void> write(const MutablePlaneView& into) const;
    [[nodiscard]] uint32_t count() const { return count_; }
    // Resets the sums and keeps the shape.
    void clear();

private:
    void widen();
    [[nodiscard]] uint32_t maximum() const;

    PlaneView shape_;
    size_t rowComponents_;
    uint32_t count_ = 0;
    uint32_t in16Bits_ = 0; // pictures in sums16_ that are not in wide_
    std::vector<uint16_t> sums16_;
    std::vector<uint32_t> wide_; // RGBA8: from the 258th picture on; RGB10A2: always
    std::vector<float> floats_;
    std::vector<double> doubles_;
};

} // namespace mural::compositor
