// The readers behind parseMesh(). Each returns positions and indices, which finishMesh() validates.
#pragma once

#include "examples/data/mesh.hpp"

namespace mural::examples {

Result<Mesh> parsePly(std::string_view bytes, const std::string& file);
Result<Mesh> parseOff(std::string_view bytes, const std::string& file);
Result<Mesh> parseStl(std::string_view bytes, const std::string& file);
Result<Mesh> parseObj(std::string_view bytes, const std::string& file);
[[nodiscard]] bool isStl(std::string_view bytes);

// Appends a polygon as a fan of triangles. A polygon with fewer than three corners has no triangles.
class Fan {
public:
    explicit Fan(std::vector<uint32_t>& indices) : indices_(indices) {}
    void add(uint32_t index) {
        if (corners_ >= 2) indices_.insert(indices_.end(), {first_, last_, index});
        if (corners_ == 0) first_ = index;
        last_ = index;
        ++corners_;
    }

private:
    std::vector<uint32_t>& indices_;
    uint32_t first_ = 0, last_ = 0;
    uint64_t corners_ = 0;
};

} // namespace mural::examples
