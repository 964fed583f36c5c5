// The division of a volume into slabs along its longest axis, for sort-last rendering. A slab is convex, so the
// pictures of slabs blend in the order of their distances from the eye. Source: thesis, "Application Examples": eVolve.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/geometry/range.hpp"
#include "examples/data/volume.hpp"

namespace mural::examples {

// A volume whose last axis, along which voxels of one slice are contiguous, is its longest.
struct SlicedVolume {
    Volume volume;
    std::array<uint32_t, 3> axes{0, 1, 2}; // for each axis of `volume`: the axis of the original

    [[nodiscard]] uint32_t slices() const { return volume.size[2]; }
    [[nodiscard]] size_t bytesPerSlice() const {
        return size_t{volume.size[0]} * volume.size[1] * volume.bytesPerVoxel;
    }
    // The voxels of the slices [first, end).
    [[nodiscard]] std::span<const std::byte> slicesOf(uint32_t first, uint32_t end) const {
        return std::span(volume.voxels).subspan(first * bytesPerSlice(), (end - first) * bytesPerSlice());
    }
};

// Exchanges the longest axis with the last one. Of equally long axes, the last is taken.
SlicedVolume sliceAlongLongestAxis(Volume volume);

// Slices that a part of the range draws.
struct Slab {
    uint32_t first = 0, end = 0; // samples are taken in [first, end), in slices from the border of the volume
    uint32_t storedFirst = 0, storedEnd = 0; // the slices needed for them: with one more on each side, for
                                             // interpolation and gradients
    [[nodiscard]] bool empty() const { return first >= end; }
    friend bool operator==(const Slab&, const Slab&) = default;
};

// Returns the slab of a range. Neighbouring ranges share no slice of [first, end) and leave none out.
[[nodiscard]] Slab slabOf(const Range& range, uint32_t slices);

// Returns the distance of the eye from a slab along the axis: 0 inside. A slab with a smaller distance is in front of
// every slab with a larger distance that it overlaps on the screen. Requires a perspective projection.
[[nodiscard]] double distanceOfSlab(double eye, double from, double to);

} // namespace mural::examples
