// The distributed objects of the volume viewer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <mural/blob.hpp>
#include <mural/ref.hpp>

#include "examples/volume/transfer_function.hpp"

namespace mural::examples {

// Consecutive slices of the volume. Nodes request the bricks that their slabs need.
struct Brick {
    Blob voxels;
    template <class Visit> void fields(Visit& visit) { visit(voxels); }
};

// A volume whose last axis is its longest (SlicedVolume). It never changes.
struct Model {
    std::array<uint32_t, 3> size{}; // voxels
    std::array<double, 3> spacing{1, 1, 1};
    std::array<uint32_t, 3> axes{0, 1, 2}; // axes of the file
    uint32_t bytesPerVoxel = 1;
    uint32_t slicesPerBrick = 1;
    std::vector<Ref<Brick>> bricks; // along the last axis
    template <class Visit> void fields(Visit& visit) {
        visit(size, spacing, axes, bytesPerVoxel, slicesPerBrick, bricks);
    }
};

// The state of a frame.
struct Scene {
    Ref<Model> model;
    double turn = 0, pitch = 0; // degrees
    double step = 1;            // distance of samples along a ray, in smallest voxel spacings
    TransferFunction transfer;
    bool reports = false; // nodes print how many slices they hold
    template <class Visit> void fields(Visit& visit) { visit(model, turn, pitch, step, transfer, reports); }
};

} // namespace mural::examples
