#include "tests/programs/passes/pass_options.hpp"

#include <cstdio>
#include <cstring>
#include <optional>
#include <vector>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

namespace programs {

PassOptions takePassOptions(int& argc, char** argv) {
    PassOptions options;
    int remaining = 1;
    for (int i = 1; i < argc; ++i) {
        const char* value = i + 1 < argc ? argv[i + 1] : "";
        const auto pair = [&](float& first, float& second) {
            if (std::sscanf(value, "%f,%f", &first, &second) != 2)
                fail("%s wants two numbers, not \"%s\"", argv[i], value);
            ++i;
        };
        if (std::strcmp(argv[i], "--draw") == 0)
            options.draw = value, ++i;
        else if (std::strcmp(argv[i], "--move") == 0)
            pair(options.moveX, options.moveY);
        else if (std::strcmp(argv[i], "--eye") == 0)
            pair(options.eye, options.focus);
        else if (std::strcmp(argv[i], "--around") == 0)
            options.around = true;
        else if (std::strcmp(argv[i], "--screen") == 0) {
            PassOptions::Screen s{};
            if (std::sscanf(value, "%f,%f,%f,%f,%f,%f,%f,%f", &s.left, &s.right, &s.bottom, &s.top, &s.degrees, &s.x,
                            &s.y, &s.z) != 8)
                fail("--screen wants eight numbers, not \"%s\"", value);
            options.screen = s;
            ++i;
        } else
            argv[remaining++] = argv[i];
    }
    argc = remaining;
    return options;
}

Matrix projectionOf(const PassOptions& options, int width, int height) {
    constexpr float kNear = 1.5F, kFar = 40, kHalfHeight = 0.9F;
    if (options.screen) {
        const PassOptions::Screen& s = *options.screen;
        Matrix m = perspective((s.right - s.left) / 2 * kNear, (s.top - s.bottom) / 2 * kNear, kNear, kFar);
        m[8] = (s.right + s.left) / (s.right - s.left);
        m[9] = (s.top + s.bottom) / (s.top - s.bottom);
        return multiply(m, multiply(rotationY(-s.degrees / 180 * 3.14159265F), translation(-s.x, -s.y, -s.z)));
    }
    const float halfWidth = kHalfHeight * float(width) / float(height);
    Matrix m = perspective(halfWidth, kHalfHeight, kNear, kFar);
    // shift of the frustum's left and right edges at the near plane
    const float shift = -options.eye * kNear / options.focus;
    m[8] = shift / halfWidth;
    return multiply(m, translation(-options.eye, 0, 0));
}

Matrix modelViewOf(const PassOptions& options, int frame) {
    if (options.around)
        return multiply(scaling(3, 3, 3),
                        multiply(rotationY(0.3F * float(frame) + 0.2F), rotationZ(0.1F * float(frame))));
    return multiply(translation(0.2F, -0.1F, -7),
                    multiply(rotationY(0.3F * float(frame) + 0.2F), rotationZ(0.1F * float(frame))));
}

const float* sceneVertices() {
    static const std::vector<float> vertices = [] {
        Sequence numbers(11);
        std::vector<float> values;
        for (int i = 0; i < kSceneVertices / 3; ++i) {
            const float x = numbers.unit() * 6 - 3, y = numbers.unit() * 5 - 2.5F, z = numbers.unit() * 6 - 3;
            for (int corner = 0; corner < 3; ++corner) {
                for (const float at : {x, y, z}) values.push_back(at + numbers.unit() * 2.4F - 1.2F);
                for (int k = 0; k < 3; ++k) values.push_back(0.2F + 0.8F * numbers.unit());
            }
        }
        return values;
    }();
    return vertices.data();
}

} // namespace programs
