// glVertexAttrib in all its forms, outside and inside glBegin, with floats, integers and doubles.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint floats, integers, unsignedIntegers, doubles;
constexpr GLuint kAttribute = 5;

const char* const kFragment = "#version 410\nin vec4 color; out vec4 result;\n"
                              "void main() { result = color; }\n";

GLuint makeProgram(const char* vertex) {
    return buildProgram({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, kFragment}}, [](unsigned program) {
        glBindAttribLocation(program, 0, "place");
        glBindAttribLocation(program, kAttribute, "value");
    });
}

void setUp() {
    floats = makeProgram("#version 410\nin vec2 place; in vec4 value; out vec4 color;\n"
                         "void main() { gl_Position = vec4(place, 0, 1); color = abs(value); }\n");
    integers = makeProgram("#version 410\nin vec2 place; in ivec4 value; out vec4 color;\n"
                           "void main() { gl_Position = vec4(place, 0, 1); color = vec4(abs(value)) / 100.0; }\n");
    unsignedIntegers = makeProgram("#version 410\nin vec2 place; in uvec4 value; out vec4 color;\n"
                                   "void main() { gl_Position = vec4(place, 0, 1); color = vec4(value) / 100.0; }\n");
    doubles = makeProgram("#version 410\nin vec2 place; in dvec4 value; out vec4 color;\n"
                          "void main() { gl_Position = vec4(place, 0, 1); color = vec4(abs(value)); }\n");
}

int cellIndex;

// Draws a quad in the next cell of a 10×9 grid. The value changes at the second corner when `inside`.
template <class Attribute> void quad(const Attribute& attribute) {
    const float x = -0.98F + 0.195F * float(cellIndex % 10);
    const float y = -0.98F + 0.21F * float(cellIndex / 10);
    ++cellIndex;
    attribute(0);
    glBegin(GL_TRIANGLE_STRIP);
    glVertexAttrib2f(0, x, y);
    attribute(1);
    glVertexAttrib2f(0, x + 0.17F, y);
    const GLfloat third[] = {x, y + 0.18F};
    glVertexAttrib2fv(0, third);
    attribute(2);
    glVertexAttrib2d(0, double(x) + 0.17, double(y) + 0.18);
    glEnd();
}

template <class T> T level(int i, int k, double full) { return static_cast<T>(full * ((i * 3 + k) % 5) / 5.0); }

#define FLOAT_FORMS(type, letter, full)                                                                                \
    quad([&](int i) { glVertexAttrib1##letter(kAttribute, level<type>(i, frame, full)); });                            \
    quad([&](int i) {                                                                                                  \
        const type v[] = {level<type>(i, 1, full)};                                                                    \
        glVertexAttrib1##letter##v(kAttribute, v);                                                                     \
    });                                                                                                                \
    quad([&](int i) { glVertexAttrib2##letter(kAttribute, level<type>(i, 2, full), level<type>(i, frame, full)); });   \
    quad([&](int i) {                                                                                                  \
        const type v[] = {level<type>(i, frame, full), level<type>(i, 3, full)};                                       \
        glVertexAttrib2##letter##v(kAttribute, v);                                                                     \
    });                                                                                                                \
    quad([&](int i) {                                                                                                  \
        glVertexAttrib3##letter(kAttribute, level<type>(i, 4, full), level<type>(i, frame, full),                      \
                                level<type>(i, 1, full));                                                              \
    });                                                                                                                \
    quad([&](int i) {                                                                                                  \
        const type v[] = {level<type>(i, 1, full), level<type>(i, 3, full), level<type>(i, frame, full)};              \
        glVertexAttrib3##letter##v(kAttribute, v);                                                                     \
    });                                                                                                                \
    quad([&](int i) {                                                                                                  \
        glVertexAttrib4##letter(kAttribute, level<type>(i, frame, full), level<type>(i, 2, full),                      \
                                level<type>(i, 3, full), level<type>(i, 1, full));                                     \
    });                                                                                                                \
    quad([&](int i) {                                                                                                  \
        const type v[] = {level<type>(i, 2, full), level<type>(i, frame, full), level<type>(i, 0, full),               \
                          level<type>(i, 1, full)};                                                                    \
        glVertexAttrib4##letter##v(kAttribute, v);                                                                     \
    })

#define VECTOR_FORM(type, name, full)                                                                                  \
    quad([&](int i) {                                                                                                  \
        const type v[] = {level<type>(i, frame, full), level<type>(i, 2, full), level<type>(i, 1, full),               \
                          level<type>(i, 3, full)};                                                                    \
        name(kAttribute, v);                                                                                           \
    })

void drawFloats(int frame) {
    glUseProgram(floats);
    FLOAT_FORMS(GLfloat, f, 1.0);
    FLOAT_FORMS(GLdouble, d, 1.0);
    FLOAT_FORMS(GLshort, s, 5.0);
    VECTOR_FORM(GLbyte, glVertexAttrib4bv, 4.0);
    VECTOR_FORM(GLint, glVertexAttrib4iv, 4.0);
    VECTOR_FORM(GLubyte, glVertexAttrib4ubv, 4.0);
    VECTOR_FORM(GLuint, glVertexAttrib4uiv, 4.0);
    VECTOR_FORM(GLushort, glVertexAttrib4usv, 4.0);
    VECTOR_FORM(GLbyte, glVertexAttrib4Nbv, 127.0);
    VECTOR_FORM(GLint, glVertexAttrib4Niv, 2147483647.0);
    VECTOR_FORM(GLshort, glVertexAttrib4Nsv, 32767.0);
    VECTOR_FORM(GLubyte, glVertexAttrib4Nubv, 255.0);
    VECTOR_FORM(GLuint, glVertexAttrib4Nuiv, 4294967295.0);
    VECTOR_FORM(GLushort, glVertexAttrib4Nusv, 65535.0);
    quad([&](int i) { glVertexAttrib4Nub(kAttribute, GLubyte(i * 70), GLubyte(frame * 40), 90, 255); });
    const auto packed = [&](int i) {
        return unsigned(i) * 300U | (unsigned(frame) * 200U << 10) | (400U << 20) | (3U << 30);
    };
    quad([&](int i) { glVertexAttribP4ui(kAttribute, GL_UNSIGNED_INT_2_10_10_10_REV, GL_TRUE, packed(i)); });
    quad([&](int i) { glVertexAttribP3ui(kAttribute, GL_INT_2_10_10_10_REV, GL_TRUE, packed(i)); });
    quad([&](int i) {
        const GLuint value = packed(i);
        glVertexAttribP2uiv(kAttribute, GL_UNSIGNED_INT_2_10_10_10_REV, GL_TRUE, &value);
    });
}

void drawIntegers(int frame) {
    glUseProgram(integers);
    quad([&](int i) { glVertexAttribI1i(kAttribute, i * 30 + frame); });
    quad([&](int i) { glVertexAttribI2i(kAttribute, i * 30, -frame * 20); });
    quad([&](int i) { glVertexAttribI3i(kAttribute, i * 30, frame * 20, 50); });
    quad([&](int i) { glVertexAttribI4i(kAttribute, -i * 30, frame * 20, 50, 100); });
    VECTOR_FORM(GLint, glVertexAttribI4iv, 100.0);
    VECTOR_FORM(GLbyte, glVertexAttribI4bv, 100.0);
    VECTOR_FORM(GLshort, glVertexAttribI4sv, 100.0);
    VECTOR_FORM(GLint, glVertexAttribI3iv, 100.0);
    glUseProgram(unsignedIntegers);
    quad([&](int i) { glVertexAttribI1ui(kAttribute, GLuint(i * 30 + frame)); });
    quad([&](int i) { glVertexAttribI4ui(kAttribute, GLuint(i * 30), 20, GLuint(frame * 20), 1); });
    VECTOR_FORM(GLuint, glVertexAttribI4uiv, 100.0);
    VECTOR_FORM(GLubyte, glVertexAttribI4ubv, 100.0);
    VECTOR_FORM(GLushort, glVertexAttribI4usv, 100.0);
    VECTOR_FORM(GLuint, glVertexAttribI2uiv, 100.0);
}

void drawDoubles(int frame) {
    glUseProgram(doubles);
    quad([&](int i) { glVertexAttribL1d(kAttribute, i * 0.3 + frame * 0.05); });
    quad([&](int i) { glVertexAttribL2d(kAttribute, i * 0.3, frame * 0.2); });
    quad([&](int i) { glVertexAttribL3d(kAttribute, frame * 0.1, i * 0.3, 0.5); });
    quad([&](int i) { glVertexAttribL4d(kAttribute, 0.2, i * 0.3, frame * 0.25, 1); });
    VECTOR_FORM(GLdouble, glVertexAttribL1dv, 1.0);
    VECTOR_FORM(GLdouble, glVertexAttribL2dv, 1.0);
    VECTOR_FORM(GLdouble, glVertexAttribL3dv, 1.0);
    VECTOR_FORM(GLdouble, glVertexAttribL4dv, 1.0);
}

// Shows the current value, which must be the one set last.
void showCurrentValue() {
    GLfloat current[4] = {};
    glGetVertexAttribfv(3, GL_CURRENT_VERTEX_ATTRIB, current);
    for (int i = 0; i < 4; ++i) {
        showBits(34 + i, current[i]);
    }
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Compatibility, 4, 3};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.2F, 0.2F, 0.25F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            cellIndex = 0;
            drawFloats(frame);
            drawIntegers(frame);
            drawDoubles(frame);
            glUseProgram(0);
            glVertexAttrib4f(3, float(frame) * 0.1F, 2.5F, -1, 7);
            showCurrentValue();
        });
}
