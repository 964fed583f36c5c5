// Random views, boxes and points for the tests of culling. Clip coordinates are computed in 32 bits, as drivers do.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "nodes/culling/linear_view.hpp"
#include "nodes/culling/tile_planes.hpp"

namespace mural::culling {

struct RandomView {
    std::mt19937 numbers;
    float projection[16] = {}, modelview[16] = {};

    explicit RandomView(unsigned seed) : numbers(seed) {
        const float near = between(0.01F, 2), far = near * between(10, 1e4F), width = between(0.2F, 2) * near;
        projection[0] = near / width;
        projection[5] = near / width * between(0.5F, 2);
        projection[8] = between(-1, 1);
        projection[10] = -(far + near) / (far - near);
        projection[11] = -1;
        projection[14] = -2 * far * near / (far - near);
        for (float& value : modelview) value = between(-2, 2);
        modelview[3] = modelview[7] = modelview[11] = 0;
        for (int i = 12; i < 15; ++i) modelview[i] = between(-30, 30);
        modelview[15] = 1;
    }
    float between(float from, float to) { return std::uniform_real_distribution<float>(from, to)(numbers); }

    // x, y and w of the position, in floats.
    [[nodiscard]] std::array<float, 3> clip(const float (&position)[3]) const {
        float product[16];
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) {
                float sum = 0;
                for (int k = 0; k < 4; ++k) sum += projection[4 * k + row] * modelview[4 * column + k];
                product[4 * column + row] = sum;
            }
        const auto at = [&](int row) {
            return product[row] * position[0] + product[4 + row] * position[1] + product[8 + row] * position[2] +
                   product[12 + row];
        };
        return {at(0), at(1), at(3)};
    }
};

} // namespace mural::culling
