// The average of n pictures (subpixel compounds, accumulated frames), from sums that lose nothing: whatever n and the order of
// the pictures, an 8 or 10 bit component is at most half a unit away from the exact average, and a tie goes up.
// RGBA16F sums in single and RGBA32F in double precision; there only the order of the pictures can show, in the last bit.
#pragma once

#include <cstdint>
#include <vector>

#include "common/result.hpp"
#include "compositor/image/plane.hpp"

namespace mural::compositor {

class Average {
public:
    // Colour formats.
    Average(PlaneFormat format, int32_t width, int32_t height);

    // Errors: another shape; more pictures than the sums hold (kMostAveraged8, kMostAveraged10, 8192 for floats).
    [[nodiscard]] Result<void> add(const PlaneView& picture);
    // Errors: another shape; no picture was added.
    [[nodiscard]] Result<void> write(const MutablePlaneView& into) const;
    [[nodiscard]] uint32_t count() const { return count_; }
    // Begins anew with the same shape.
    void clear();

private:
    void widen();
    [[nodiscard]] uint32_t most() const;

    PlaneView shape_;
    size_t rowComponents_;
    uint32_t count_ = 0;
    uint32_t in16Bits_ = 0; // pictures that sums16_ holds and wide_ does not
    std::vector<uint16_t> sums16_;
    std::vector<uint32_t> wide_; // of RGBA8, from the 258th picture on; of RGB10A2
    std::vector<float> floats_;
    std::vector<double> doubles_;
};

} // namespace mural::compositor
