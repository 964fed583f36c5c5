// The distributed objects of the polygon viewer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <mural/blob.hpp>
#include <mural/ref.hpp>

#include "examples/ply/kd_tree.hpp"

namespace mural::examples {

// One leaf of the tree: packLeaf(). Nodes request the leaves that they draw.
struct Leaf {
    Blob geometry;
    template <class Visit> void fields(Visit& visit) { visit(geometry); }
};

// A mesh. It never changes.
struct Model {
    KdTree tree;
    std::vector<Ref<Leaf>> leaves; // one per leaf of the tree
    std::array<double, 3> centre{};
    double radius = 1; // of a sphere around the mesh
    template <class Visit> void fields(Visit& visit) { visit(tree, leaves, centre, radius); }
};

// The state of a frame.
struct Scene {
    Ref<Model> model;
    double turn = 0, pitch = 0;           // degrees
    std::array<float, 3> colour{1, 1, 1}; // multiplied with the colours of the mesh
    bool reports = false;                 // nodes print how many leaves they hold
    template <class Visit> void fields(Visit& visit) { visit(model, turn, pitch, colour, reports); }
};

} // namespace mural::examples
