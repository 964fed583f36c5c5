// Meshes of the programs for culling: vertices that lie close together follow each other, so that clusters are small.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/programs/support/gl.hpp"

namespace programs {

struct Vertex {
    float x, y, z;
    GLubyte colour[4];
};

// A wavy field of columns x rows cells with `each` vertices per cell: 6 for triangles, 4 for quads, 2 for lines, 1 for
// points.
inline std::vector<Vertex> field(int columns, int rows, int each) {
    constexpr int kCorners[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 1}};
    std::vector<Vertex> vertices;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            for (int corner = 0; corner < each; ++corner) {
                const int c = column + kCorners[corner][0], r = row + kCorners[corner][1];
                const float x = 2.0F * static_cast<float>(c) / static_cast<float>(columns) - 1;
                const float y = 2.0F * static_cast<float>(r) / static_cast<float>(rows) - 1;
                vertices.push_back(
                    {x,
                     y,
                     0.2F * std::sin(5 * x + 3 * y),
                     {static_cast<GLubyte>(40 + 200 * c / columns), static_cast<GLubyte>(40 + 200 * r / rows),
                      static_cast<GLubyte>(37 * (c + r)), 160}});
            }
    return vertices;
}

inline GLuint bufferOf(GLenum target, std::size_t sizeBytes, const void* bytes, GLenum usage = GL_STATIC_DRAW) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(sizeBytes), bytes, usage);
    return buffer;
}

inline const void* offsetOf(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

} // namespace programs
