#include "examples/volume/slabs.hpp"

#include <algorithm>
#include <cstring>

namespace mural::examples {
namespace {

// Copies voxels so that axis `axis` and the last one are exchanged.
std::vector<std::byte> exchanged(const Volume& volume, size_t axis) {
    const std::array<uint32_t, 3>& from = volume.size;
    std::array<size_t, 3> steps{1, from[0], size_t{from[0]} * from[1]}; // of the source, for the axes of the result
    std::array<uint32_t, 3> to = from;
    std::swap(steps[axis], steps[2]);
    std::swap(to[axis], to[2]);
    const size_t bytes = volume.bytesPerVoxel;
    std::vector<std::byte> out(volume.voxels.size());
    std::byte* at = out.data();
    for (size_t z = 0; z < to[2]; ++z) {
        for (size_t y = 0; y < to[1]; ++y) {
            for (size_t x = 0; x < to[0]; ++x, at += bytes)
                std::memcpy(at, volume.voxels.data() + (x * steps[0] + y * steps[1] + z * steps[2]) * bytes, bytes);
        }
    }
    return out;
}

} // namespace

SlicedVolume sliceAlongLongestAxis(Volume volume) {
    SlicedVolume sliced;
    size_t longest = 2;
    for (size_t axis = 0; axis < 2; ++axis) {
        if (volume.size[axis] > volume.size[longest]) longest = axis;
    }
    if (longest != 2) {
        volume.voxels = exchanged(volume, longest);
        std::swap(volume.size[longest], volume.size[2]);
        std::swap(volume.spacing[longest], volume.spacing[2]);
        std::swap(sliced.axes[longest], sliced.axes[2]);
    }
    sliced.volume = std::move(volume);
    return sliced;
}

Slab slabOf(const Range& range, uint32_t slices) {
    Slab slab;
    slab.first = static_cast<uint32_t>(countBefore(range.start, slices));
    slab.end = std::max(slab.first, static_cast<uint32_t>(countBefore(range.end, slices)));
    if (slab.empty()) {
        slab.storedFirst = slab.storedEnd = slab.first;
    } else {
        slab.storedFirst = slab.first > 0 ? slab.first - 1 : 0;
        slab.storedEnd = std::min(slab.end + 1, slices);
    }
    return slab;
}

double distanceOfSlab(double eye, double from, double to) {
    if (eye < from) return from - eye;
    return eye > to ? eye - to : 0;
}

} // namespace mural::examples
