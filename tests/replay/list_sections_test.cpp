#include "nodes/replay/features/list_sections.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <GL/gl.h>
#include <gtest/gtest.h>

#include "gl_opcodes.hpp"

namespace mural::replay {
namespace {

class Recorder {
public:
    // Values take 4 bytes, doubles 8.
    template <class... T> void take(uint16_t opcode, T... values) {
        std::vector<std::byte> arguments;
        (append(arguments, values), ...);
        section.take(opcode, arguments);
    }
    ListSection section;

private:
    template <class T> static void append(std::vector<std::byte>& out, T value) {
        const size_t at = out.size();
        out.resize(at + std::max<size_t>(4, sizeof value));
        std::memcpy(out.data() + at, &value, sizeof value);
    }
};

TEST(ListSection, boundsThePositionsOfAllTypes) {
    std::mt19937 numbers(1);
    std::uniform_real_distribution<double> any(-1e6, 1e6);
    for (int round = 0; round < 500; ++round) {
        Recorder list;
        list.take(op::glBegin, uint32_t{GL_TRIANGLES});
        std::vector<std::array<double, 4>> positions;
        for (int i = 0; i < 12; ++i) {
            const double x = any(numbers), y = any(numbers), z = any(numbers), w = any(numbers);
            const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
            const auto ix = static_cast<int32_t>(x), iy = static_cast<int32_t>(y);
            const auto sx = static_cast<int16_t>(x / 100), sy = static_cast<int16_t>(y / 100);
            switch (i % 4) {
            case 0:
                list.take(op::glVertex4d, x, y, z, w);
                positions.push_back({x, y, z, w});
                break;
            case 1:
                list.take(op::glVertex2f, fx, fy);
                positions.push_back({double{fx}, double{fy}, 0, 1});
                break;
            case 2:
                list.take(op::glVertex3iv, ix, iy, int32_t{7});
                positions.push_back({double(ix), double(iy), 7, 1});
                break;
            default: list.take(op::glVertex2s, sx, sy); positions.push_back({double(sx), double(sy), 0, 1});
            }
        }
        list.take(op::glEnd);
        ASSERT_TRUE(list.section.isPlain());
        const ListedPrimitives& primitives = list.section.primitives();
        EXPECT_EQ(primitives.vertices, positions.size());
        EXPECT_EQ(primitives.modes, 1U << GL_TRIANGLES);
        for (const auto& position : positions)
            for (size_t c = 0; c < 4; ++c) {
                ASSERT_LE(double{primitives.lowest[c]}, position[c]);
                ASSERT_GE(double{primitives.highest[c]}, position[c]);
            }
    }
}

TEST(ListSection, keepsOneCommandPerAttributeInTheirOrder) {
    Recorder list;
    const auto material = [&](GLenum name) { list.take(op::glMaterialf, uint32_t{GL_FRONT}, uint32_t{name}, 1.0F); };
    material(GL_EMISSION);
    list.take(op::glBegin, uint32_t{GL_POINTS});
    for (int i = 0; i < 10; ++i) {
        list.take(op::glColor3f, 0.1F * static_cast<float>(i), 0.0F, 0.0F);
        list.take(op::glMultiTexCoord2f, uint32_t{GL_TEXTURE0} + static_cast<uint32_t>(i % 2), 0.0F, 0.0F);
    }
    list.take(op::glVertex2f, 0.0F, 0.0F);
    list.take(op::glColor3f, 0.5F, 0.0F, 0.0F);
    list.take(op::glVertex2f, 1.0F, 0.0F);
    list.take(op::glEnd);
    EXPECT_TRUE(list.section.isPlain());
    EXPECT_EQ(list.section.attributesBefore().size(), 1U);
    std::vector<uint16_t> opcodes;
    for (const ListedAttribute& a : list.section.attributesInside()) opcodes.push_back(a.opcode);
    EXPECT_EQ(opcodes, (std::vector<uint16_t>{op::glMultiTexCoord2f, op::glMultiTexCoord2f, op::glColor3f}));
    float red = 0;
    std::memcpy(&red, list.section.attributesInside().back().arguments.data(), 4);
    EXPECT_EQ(red, 0.5F);
}

// Lists with anything but bounded primitives are drawn whole.
TEST(ListSection, isNotPlainWithOtherContents) {
    const auto isPlain = [](auto inside) {
        Recorder list;
        list.take(op::glBegin, uint32_t{GL_TRIANGLES});
        list.take(op::glVertex2f, 1.0F, 2.0F);
        inside(list);
        list.take(op::glEnd);
        return list.section.isPlain();
    };
    EXPECT_TRUE(isPlain([](Recorder&) {}));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glColor3f, 1.0F, 1.0F, 1.0F); }))
        << "an attribute after a vertex";
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glVertex2f, NAN, 2.0F); }));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glVertex3d, 1e300, 2.0, 1.0); }));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glVertex3f, 1.0F); })) << "a short record";
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glEvalCoord1f, 1.0F); }));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glArrayElement, 3); }));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glVertexAttrib2f, 0, 1.0F, 1.0F); }));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glCallList, 3); }));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glEnable, uint32_t{GL_LIGHTING}); }));
}

TEST(ListSection, isNotPlainWithCommandsOutsideOfPrimitives) {
    const auto isPlain = [](auto before, auto after) {
        Recorder list;
        before(list);
        list.take(op::glBegin, uint32_t{GL_TRIANGLES});
        list.take(op::glNormal3f, 0.0F, 0.0F, 1.0F);
        list.take(op::glVertex2f, 1.0F, 2.0F);
        list.take(op::glEnd);
        after(list);
        return list.section.isPlain();
    };
    const auto nothing = [](Recorder&) {};
    EXPECT_TRUE(isPlain(nothing, nothing));
    EXPECT_TRUE(isPlain([](Recorder& l) { l.take(op::glColor3f, 1.0F, 0.0F, 0.0F); }, nothing));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glNormal3f, 1.0F, 0.0F, 0.0F); }, nothing)) << "set inside, too";
    EXPECT_FALSE(isPlain(nothing, [](Recorder& l) { l.take(op::glColor3f, 1.0F, 0.0F, 0.0F); }));
    EXPECT_FALSE(isPlain([](Recorder& l) { l.take(op::glPushMatrix); }, nothing));
    EXPECT_FALSE(isPlain(nothing, [](Recorder& l) { l.take(op::glPopAttrib); }));
    EXPECT_FALSE(isPlain(nothing, [](Recorder& l) { l.take(op::glBegin, uint32_t{GL_LINES}); })) << "not ended";
    EXPECT_FALSE(isPlain(nothing, [](Recorder& l) { l.take(op::glEvalMesh1, 1, 2, 3); }));
}

} // namespace
} // namespace mural::replay
