#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "examples/ply/kd_tree.hpp"
#include "examples/ply/leaf_geometry.hpp"

namespace mural::examples {
namespace {

Mesh cloud(size_t triangles) {
    Mesh mesh;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-1, 1);
    for (size_t t = 0; t < triangles; ++t) {
        const Point centre{4 * place(random), place(random), place(random)};
        for (uint32_t corner = 0; corner < 3; ++corner) {
            mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
            mesh.positions.push_back({centre[0] + .01f * place(random), centre[1], centre[2] + .01f * place(random)});
        }
    }
    computeNormals(mesh);
    return mesh;
}

bool isInside(const Box& box, const Point& point) {
    for (size_t k = 0; k < 3; ++k) {
        if (point[k] < box.lowest[k] || point[k] > box.highest[k]) return false;
    }
    return true;
}

TEST(KdTree, putsEachTriangleIntoOneLeaf) {
    for (const size_t triangles : {size_t{1}, size_t{63}, size_t{64}, size_t{65}, size_t{10'000}}) {
        const Mesh mesh = cloud(triangles);
        std::vector<uint32_t> order;
        const KdTree tree = KdTree::build(mesh, order, 64);
        EXPECT_EQ(tree.triangles(), triangles);
        EXPECT_EQ(tree.leaves(), (triangles + 63) / 64);
        EXPECT_EQ(std::set<uint32_t>(order.begin(), order.end()).size(), triangles);
        for (uint32_t leaf = 0; leaf < tree.leaves(); ++leaf) {
            const uint64_t size = tree.endTriangle(leaf) - tree.firstTriangle(leaf);
            EXPECT_LE(size, 64u);
            EXPECT_GE(size + 8, triangles / tree.leaves()) << "leaves have nearly equal sizes";
        }
    }
}

TEST(KdTree, hasBoxesAroundAllTriangles) {
    const Mesh mesh = cloud(5000);
    std::vector<uint32_t> order;
    const KdTree tree = KdTree::build(mesh, order, 100);
    double volume = 0;
    for (const KdNode& node : tree.nodes()) {
        for (uint64_t at = tree.firstTriangle(node.firstLeaf); at < tree.endTriangle(node.endLeaf - 1); ++at) {
            for (size_t corner = 0; corner < 3; ++corner)
                ASSERT_TRUE(isInside(node.box, mesh.positions[mesh.indices[3 * size_t{order[at]} + corner]]));
        }
        if (node.endLeaf - node.firstLeaf > 1) continue;
        double size = 1;
        for (size_t k = 0; k < 3; ++k) size *= node.box.highest[k] - node.box.lowest[k];
        volume += size;
    }
    EXPECT_LT(volume, 1.3 * 8 * 2 * 2) << "the boxes of leaves hardly overlap";
}

TEST(KdTree, dividesLeavesAmongRanges) {
    const Mesh mesh = cloud(3000);
    std::vector<uint32_t> order;
    const KdTree tree = KdTree::build(mesh, order, 50);
    EXPECT_EQ(tree.leavesOf({0, 1}), (LeafRun{0, tree.leaves()}));
    for (const int parts : {2, 3, 4, 7, 1000}) {
        uint32_t next = 0;
        for (int part = 0; part < parts; ++part) {
            const LeafRun run = tree.leavesOf({double(part) / parts, double(part + 1) / parts});
            EXPECT_EQ(run.first, next);
            EXPECT_GE(run.end, run.first);
            if (parts <= 4) {
                EXPECT_NEAR(run.end - run.first, tree.leaves() / parts, 1);
            }
            next = run.end;
        }
        EXPECT_EQ(next, tree.leaves());
    }
    EXPECT_EQ(tree.leavesOf({.4, .4}).first, tree.leavesOf({.4, .4}).end);
}

TEST(KdTree, visitsLeavesOfTheRunInOrder) {
    const Mesh mesh = cloud(3000);
    std::vector<uint32_t> order;
    const KdTree tree = KdTree::build(mesh, order, 50);
    const auto visited = [&](const LeafRun& run, auto isOutside) {
        std::vector<uint32_t> leaves;
        tree.visit(run, isOutside, [&](uint32_t leaf) { leaves.push_back(leaf); });
        return leaves;
    };
    EXPECT_EQ(visited({7, 10}, [](const Box&) { return false; }), (std::vector<uint32_t>{7, 8, 9}));
    EXPECT_TRUE(visited({0, 60}, [](const Box&) { return true; }).empty());
    const std::vector<uint32_t> left = visited({0, 60}, [](const Box& box) { return box.lowest[0] > 0; });
    EXPECT_TRUE(std::is_sorted(left.begin(), left.end()));
    EXPECT_GT(left.size(), 25u);
    EXPECT_LT(left.size(), 40u);
}

TEST(KdTree, needsNoSplitBetweenEqualTriangles) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (int t = 0; t < 1000; ++t) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
    std::vector<uint32_t> order;
    EXPECT_EQ(KdTree::build(mesh, order, 10).leaves(), 100u);
}

TEST(KdTree, visitsDamagedTreesOnce) {
    // A node refers backwards: the visit ends.
    struct Damage {
        void operator()(std::vector<KdNode>& nodes, std::vector<uint64_t>&) { nodes.resize(3); }
    } damage;
    KdTree tree;
    tree.fields(damage);
    int calls = 0;
    tree.visit(
        {0, 1}, [&](const Box&) { return ++calls > 0; }, [](uint32_t) {});
    EXPECT_LE(calls, 3);
}

TEST(LeafGeometry, survivesPacking) {
    Mesh mesh = cloud(20);
    mesh.indices[4] = 0; // a shared vertex
    computeNormals(mesh);
    mesh.colours.assign(mesh.positions.size(), {1, 2, 3, 4});
    const std::vector<uint32_t> triangles{1, 0, 7};
    const std::vector<std::byte> bytes = packLeaf(mesh, triangles);
    const auto view = viewLeaf(bytes);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->vertices.size(), 8u);
    ASSERT_EQ(view->indices.size(), 9u);
    EXPECT_EQ(view->indices[1], view->indices[3]) << "both triangles have vertex 0";
    for (size_t at = 0; at < 9; ++at) {
        const uint32_t index = mesh.indices[3 * triangles[at / 3] + at % 3];
        const LeafVertex& vertex = view->vertices[view->indices[at]];
        EXPECT_EQ(vertex.position, mesh.positions[index]);
        EXPECT_NEAR(vertex.normal[1] / 32767., mesh.normals[index][1], 1e-4);
        EXPECT_EQ(vertex.colour, (Colour{1, 2, 3, 4}));
    }
}

TEST(LeafGeometry, refusesDamagedBytes) {
    const std::vector<uint32_t> triangles{0, 1, 2};
    const std::vector<std::byte> good = packLeaf(cloud(3), triangles);
    EXPECT_FALSE(viewLeaf({}));
    EXPECT_FALSE(viewLeaf(std::span(good).first(good.size() - 1)));
    std::vector<std::byte> bad = good;
    bad[4] = std::byte{8}; // fewer vertices
    EXPECT_FALSE(viewLeaf(bad));
    bad = good;
    bad.back() = std::byte{0xff}; // an index
    EXPECT_FALSE(viewLeaf(bad));
}

} // namespace
} // namespace mural::examples
