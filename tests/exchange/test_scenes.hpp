// One picture drawn by a single node, and by several that divide its draws.
#pragma once

#include "tests/exchange/test_parts.hpp"

#include <set>
#include <vector>

namespace mural::test {

struct Scene {
    CompositeRule rule;
    PicturePart whole; // of a single node
    std::vector<PicturePart> parts;
};

inline Scene sceneOf(std::mt19937& random, int ranks, const CompositeRule& rule, int32_t width, int32_t height) {
    Scene s{rule, clearedPart(width, height, rule), {}};
    for (int rank = 0; rank < ranks; ++rank) {
        s.parts.push_back(clearedPart(width, height, rule));
        if (rank % 5 == 4) continue; // a node without draws
        for (const Fragment& f : fragmentsOf(random, s.whole.colour.size(), rule)) {
            draw(s.whole, f.at, f.colour, f.depth, rule);
            draw(s.parts.back(), f.at, f.colour, f.depth, rule);
        }
    }
    return s;
}

// Folds the remaining parts, as the collector does.
inline PicturePart foldedWithout(const Scene& scene, const std::set<int>& lost) {
    PicturePart picture = scene.parts[0];
    for (size_t rank = 1; rank < scene.parts.size(); ++rank) {
        const PicturePart& part = scene.parts[rank];
        if (!lost.contains(static_cast<int>(rank)))
            compositeRow({picture.colour.data(), picture.depth.data(), part.colour.data(), part.depth.data(),
                          part.colour.size()},
                         LayerOrder::Later, scene.rule);
    }
    return picture;
}

} // namespace mural::test
