// Immediate mode: every way to set an attribute of the current vertex.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <GL/glext.h>

using namespace programs;

namespace {

constexpr int kColumns = 10;

// The lower left corner of cell `index` in a grid of 10 columns and cells of 24×18 units.
struct Cell {
    int x, y;
};

Cell cellOf(int index) { return {2 + (index % kColumns) * 24, 2 + (index / kColumns) * 18}; }

// Draws a quad in the cell; calls `attribute` before each corner with the corner's number.
template <class Attribute> void quad(int index, const Attribute& attribute) {
    const Cell cell = cellOf(index);
    glBegin(GL_QUADS);
    const int corners[4][2] = {{0, 0}, {20, 0}, {20, 14}, {0, 14}};
    for (int i = 0; i < 4; ++i) {
        attribute(i);
        glVertex2i(cell.x + corners[i][0], cell.y + corners[i][1]);
    }
    glEnd();
}

// Draws one triangle with each glVertex entry point.
void drawVertices(int frame) {
    const auto triangle = [&](int index, auto vertex) {
        const Cell cell = cellOf(index);
        glBegin(GL_TRIANGLES);
        vertex(cell.x, cell.y);
        vertex(cell.x + 20, cell.y + frame);
        vertex(cell.x + 10, cell.y + 14);
        glEnd();
    };
    using S = GLshort;
    using F = GLfloat;
    using D = GLdouble;
    glColor3f(0.3F, 0.8F, 0.9F);
    triangle(0, [](int x, int y) { glVertex2d(x + 0.25, y); });
    triangle(1, [](int x, int y) {
        const D v[] = {x + 0.5, D(y)};
        glVertex2dv(v);
    });
    triangle(2, [](int x, int y) { glVertex2f(F(x), F(y) + 0.5F); });
    triangle(3, [](int x, int y) {
        const F v[] = {F(x), F(y)};
        glVertex2fv(v);
    });
    triangle(4, [](int x, int y) { glVertex2i(x, y); });
    triangle(5, [](int x, int y) {
        const GLint v[] = {x, y};
        glVertex2iv(v);
    });
    triangle(6, [](int x, int y) { glVertex2s(S(x), S(y)); });
    triangle(7, [](int x, int y) {
        const S v[] = {S(x), S(y)};
        glVertex2sv(v);
    });
    triangle(8, [](int x, int y) { glVertex3d(x, y, 0.5); });
    triangle(9, [](int x, int y) {
        const D v[] = {D(x), D(y), 0.5};
        glVertex3dv(v);
    });
    triangle(10, [](int x, int y) { glVertex3f(F(x), F(y), 0.1F); });
    triangle(11, [](int x, int y) {
        const F v[] = {F(x), F(y), 0.2F};
        glVertex3fv(v);
    });
    triangle(12, [](int x, int y) { glVertex3i(x, y, 0); });
    triangle(13, [](int x, int y) {
        const GLint v[] = {x, y, 0};
        glVertex3iv(v);
    });
    triangle(14, [](int x, int y) { glVertex3s(S(x), S(y), 0); });
    triangle(15, [](int x, int y) {
        const S v[] = {S(x), S(y), 0};
        glVertex3sv(v);
    });
    triangle(16, [](int x, int y) { glVertex4d(2.0 * x, 2.0 * y, 0, 2); });
    triangle(17, [](int x, int y) {
        const D v[] = {3.0 * x, 3.0 * y, 0, 3};
        glVertex4dv(v);
    });
    triangle(18, [](int x, int y) { glVertex4f(F(x) / 2, F(y) / 2, 0, 0.5F); });
    triangle(19, [](int x, int y) {
        const F v[] = {F(x), F(y), 0, 1};
        glVertex4fv(v);
    });
    triangle(20, [](int x, int y) { glVertex4i(2 * x, 2 * y, 0, 2); });
    triangle(21, [](int x, int y) {
        const GLint v[] = {x, y, 0, 1};
        glVertex4iv(v);
    });
    triangle(22, [](int x, int y) { glVertex4s(S(x), S(y), 0, 1); });
    triangle(23, [](int x, int y) {
        const S v[] = {S(x), S(y), 0, 1};
        glVertex4sv(v);
    });
}

template <class T> T part(int i, int k, double full) { return static_cast<T>(full * ((i * 3 + k * 5) % 8) / 8.0); }

#define COLOR_FORMS(first, type, letter, full)                                                                         \
    quad(first, [&](int i) {                                                                                           \
        glColor3##letter(part<type>(i, frame, full), part<type>(i, 1, full), part<type>(i, 2, full));                  \
    });                                                                                                                \
    quad(first + 1, [&](int i) {                                                                                       \
        const type v[] = {part<type>(i, 3, full), part<type>(i, frame, full), part<type>(i, 4, full)};                 \
        glColor3##letter##v(v);                                                                                        \
    });                                                                                                                \
    quad(first + 2, [&](int i) {                                                                                       \
        glColor4##letter(part<type>(i, 5, full), part<type>(i, 6, full), part<type>(i, frame, full),                   \
                         part<type>(i, 7, full));                                                                      \
    });                                                                                                                \
    quad(first + 3, [&](int i) {                                                                                       \
        const type v[] = {part<type>(i, frame, full), part<type>(i, 2, full), part<type>(i, 6, full),                  \
                          part<type>(i, 4, full)};                                                                     \
        glColor4##letter##v(v);                                                                                        \
    })

void drawColors(int frame) {
    COLOR_FORMS(24, GLbyte, b, 127.0);
    COLOR_FORMS(28, GLdouble, d, 1.0);
    COLOR_FORMS(32, GLfloat, f, 1.0);
    COLOR_FORMS(36, GLint, i, 2147483647.0);
    COLOR_FORMS(40, GLshort, s, 32767.0);
    COLOR_FORMS(44, GLubyte, ub, 255.0);
    COLOR_FORMS(48, GLuint, ui, 4294967295.0);
    COLOR_FORMS(52, GLushort, us, 65535.0);
}

#define SECONDARY_FORMS(first, type, letter, full)                                                                     \
    quad(first, [&](int i) {                                                                                           \
        glSecondaryColor3##letter(part<type>(i, frame, full), part<type>(i, 1, full), part<type>(i, 2, full));         \
    });                                                                                                                \
    quad(first + 1, [&](int i) {                                                                                       \
        const type v[] = {part<type>(i, 3, full), part<type>(i, frame, full), part<type>(i, 4, full)};                 \
        glSecondaryColor3##letter##v(v);                                                                               \
    })

void drawSecondaryColors(int frame) {
    glEnable(GL_COLOR_SUM);
    glColor3f(0.1F, 0.0F, 0.1F);
    SECONDARY_FORMS(56, GLbyte, b, 127.0);
    SECONDARY_FORMS(58, GLdouble, d, 1.0);
    SECONDARY_FORMS(60, GLfloat, f, 1.0);
    SECONDARY_FORMS(62, GLint, i, 2147483647.0);
    SECONDARY_FORMS(64, GLshort, s, 32767.0);
    SECONDARY_FORMS(66, GLubyte, ub, 255.0);
    SECONDARY_FORMS(68, GLuint, ui, 4294967295.0);
    SECONDARY_FORMS(70, GLushort, us, 65535.0);
    glDisable(GL_COLOR_SUM);
}

// Draws normals lit by one directional light, so that each normal is a brightness.
void drawNormals(int frame) {
    const GLfloat direction[] = {0.3F, 0.2F, 1, 0};
    glLightfv(GL_LIGHT0, GL_POSITION, direction);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_NORMALIZE);
    quad(72, [&](int i) { glNormal3b(GLbyte(i * 20), GLbyte(frame * 10), 60); });
    quad(73, [&](int i) {
        const GLbyte v[] = {GLbyte(frame * 9), GLbyte(i * 12), 50};
        glNormal3bv(v);
    });
    quad(74, [&](int i) { glNormal3d(i * 0.2, frame * 0.1, 1); });
    quad(75, [&](int i) {
        const GLdouble v[] = {frame * 0.2, i * 0.1, 1};
        glNormal3dv(v);
    });
    quad(76, [&](int i) { glNormal3f(float(i) * 0.1F, 0.5F, 1); });
    quad(77, [&](int i) {
        const GLfloat v[] = {float(i) * -0.1F, float(frame) * 0.3F, 1};
        glNormal3fv(v);
    });
    quad(78, [&](int i) { glNormal3i(i << 28, frame << 26, 1 << 29); });
    quad(79, [&](int i) {
        const GLint v[] = {frame << 27, i << 28, 1 << 29};
        glNormal3iv(v);
    });
    quad(80, [&](int i) { glNormal3s(GLshort(i * 5000), GLshort(frame * 900), 12000); });
    quad(81, [&](int i) {
        const GLshort v[] = {GLshort(frame * 3000), GLshort(i * 5000), 12000};
        glNormal3sv(v);
    });
    // Materials between glBegin and glEnd.
    quad(82, [&](int i) {
        const GLfloat diffuse[] = {float(i) * 0.25F, 0.8F, float(frame) * 0.1F, 1};
        glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, diffuse);
        glNormal3f(0, 0, 1);
    });
    quad(83, [&](int i) {
        const GLint emission[] = {i << 28, frame << 27, 1 << 28, 0};
        glMaterialiv(GL_FRONT, GL_EMISSION, emission);
        glMaterialf(GL_FRONT, GL_SHININESS, float(i * 10));
        glMateriali(GL_FRONT, GL_SHININESS, i * 9);
    });
    const GLfloat black[] = {0, 0, 0, 1};
    const GLfloat grey[] = {0.8F, 0.8F, 0.8F, 1};
    glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, grey);
    glMaterialfv(GL_FRONT_AND_BACK, GL_EMISSION, black);
    glDisable(GL_LIGHTING);
}

#define TEXCOORD_FORMS(type, letter)                                                                                   \
    quad(cell++, [&](int i) { glTexCoord1##letter(type(s(i))); });                                                     \
    quad(cell++, [&](int i) {                                                                                          \
        const type v[] = {type(s(i))};                                                                                 \
        glTexCoord1##letter##v(v);                                                                                     \
    });                                                                                                                \
    quad(cell++, [&](int i) { glTexCoord2##letter(type(s(i)), type(t(i))); });                                         \
    quad(cell++, [&](int i) {                                                                                          \
        const type v[] = {type(s(i)), type(t(i))};                                                                     \
        glTexCoord2##letter##v(v);                                                                                     \
    });                                                                                                                \
    quad(cell++, [&](int i) { glTexCoord3##letter(type(s(i)), type(t(i)), 0); });                                      \
    quad(cell++, [&](int i) {                                                                                          \
        const type v[] = {type(t(i)), type(s(i)), 0};                                                                  \
        glTexCoord3##letter##v(v);                                                                                     \
    });                                                                                                                \
    quad(cell++, [&](int i) { glTexCoord4##letter(type(s(i)), type(t(i)), 0, 2); });                                   \
    quad(cell++, [&](int i) {                                                                                          \
        const type v[] = {type(s(i)), type(t(i)), 0, 1};                                                               \
        glTexCoord4##letter##v(v);                                                                                     \
    })

#define MULTITEX_FORMS(type, letter)                                                                                   \
    quad(cell++, [&](int i) { glMultiTexCoord1##letter(GL_TEXTURE1, type(s(i))); });                                   \
    quad(cell++, [&](int i) {                                                                                          \
        const type v[] = {type(t(i))};                                                                                 \
        glMultiTexCoord1##letter##v(GL_TEXTURE1, v);                                                                   \
    });                                                                                                                \
    quad(cell++, [&](int i) { glMultiTexCoord2##letter(GL_TEXTURE1, type(s(i)), type(t(i))); });                       \
    quad(cell++, [&](int i) {                                                                                          \
        const type v[] = {type(s(i)), type(t(i))};                                                                     \
        glMultiTexCoord2##letter##v(GL_TEXTURE1, v);                                                                   \
    });                                                                                                                \
    quad(cell++, [&](int i) { glMultiTexCoord3##letter(GL_TEXTURE1, type(s(i)), type(t(i)), 0); });                    \
    quad(cell++, [&](int i) {                                                                                          \
        const type v[] = {type(t(i)), type(s(i)), 0};                                                                  \
        glMultiTexCoord3##letter##v(GL_TEXTURE1, v);                                                                   \
    });                                                                                                                \
    quad(cell++, [&](int i) { glMultiTexCoord4##letter(GL_TEXTURE1, type(s(i)), type(t(i)), 0, 1); });                 \
    quad(cell++, [&](int i) {                                                                                          \
        const type v[] = {type(s(i)), type(t(i)), 0, 2};                                                               \
        glMultiTexCoord4##letter##v(GL_TEXTURE1, v);                                                                   \
    })

void drawTextureCoordinates(int frame) {
    const auto s = [&](int i) { return (i == 1 || i == 2) ? 2 + frame : 0; };
    const auto t = [&](int i) { return i >= 2 ? 3 : 0; };
    int cell = 0;
    glColor3f(1, 1, 1);
    glEnable(GL_TEXTURE_2D);
    TEXCOORD_FORMS(GLdouble, d);
    TEXCOORD_FORMS(GLfloat, f);
    TEXCOORD_FORMS(GLint, i);
    TEXCOORD_FORMS(GLshort, s);
    glDisable(GL_TEXTURE_2D);
    glActiveTexture(GL_TEXTURE1);
    glEnable(GL_TEXTURE_2D);
    MULTITEX_FORMS(GLdouble, d);
    MULTITEX_FORMS(GLfloat, f);
    MULTITEX_FORMS(GLint, i);
    MULTITEX_FORMS(GLshort, s);
    glDisable(GL_TEXTURE_2D);
    glActiveTexture(GL_TEXTURE0);
}

void drawFogCoordinates(int frame) {
    const GLfloat color[] = {0.9F, 0.4F, 0.1F, 1};
    glFogfv(GL_FOG_COLOR, color);
    glFogi(GL_FOG_MODE, GL_LINEAR);
    glFogf(GL_FOG_START, 0);
    glFogf(GL_FOG_END, 8);
    glFogi(GL_FOG_COORD_SRC, GL_FOG_COORD);
    glEnable(GL_FOG);
    glColor3f(0, 0.2F, 0.5F);
    quad(64, [&](int i) { glFogCoordf(float(i * 2 + frame)); });
    quad(65, [&](int i) {
        const GLfloat v = float(8 - i * 2);
        glFogCoordfv(&v);
    });
    quad(66, [&](int i) { glFogCoordd(i + frame * 0.5); });
    quad(67, [&](int i) {
        const GLdouble v = i * 1.5;
        glFogCoorddv(&v);
    });
    glDisable(GL_FOG);
}

// Draws rectangles, edge flags, and packed attributes of OpenGL 3.3.
void drawOthers(int frame) {
    glColor3f(0.7F, 0.7F, 0.2F);
    Cell c = cellOf(68);
    glRectf(float(c.x), float(c.y), float(c.x) + 8.5F, float(c.y + 14));
    glRecti(c.x + 10, c.y, c.x + 20, c.y + 4 + frame);
    c = cellOf(69);
    glRects(GLshort(c.x), GLshort(c.y), GLshort(c.x + 8), GLshort(c.y + 14));
    const GLdouble a[] = {c.x + 10.0, double(c.y)};
    const GLdouble b[] = {c.x + 19.5, c.y + 7.0 + frame};
    glRectdv(a, b);
    c = cellOf(70);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glBegin(GL_POLYGON);
    const GLboolean off = GL_FALSE;
    glEdgeFlag(GL_TRUE);
    glVertex2f(float(c.x) + 0.5F, float(c.y) + 0.5F);
    glEdgeFlagv(&off);
    glVertex2f(float(c.x) + 18.5F, float(c.y + frame) + 0.5F);
    glEdgeFlag(GL_TRUE);
    glVertex2f(float(c.x) + 14.5F, float(c.y) + 13.5F);
    glVertex2f(float(c.x) + 2.5F, float(c.y) + 12.5F);
    glEnd();
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    const auto packed = [](unsigned x, unsigned y, unsigned z, unsigned w) {
        return x | (y << 10) | (z << 20) | (w << 30);
    };
    quad(71, [&](int i) {
        glColorP3ui(GL_UNSIGNED_INT_2_10_10_10_REV, packed(unsigned(i) * 300, 500, unsigned(frame) * 200, 0));
    });
    quad(72, [&](int i) {
        const GLuint v = packed(900, unsigned(i) * 300, unsigned(frame) * 100, 3);
        glColorP4uiv(GL_UNSIGNED_INT_2_10_10_10_REV, &v);
    });
    c = cellOf(73);
    glBegin(GL_TRIANGLES);
    glVertexP2ui(GL_UNSIGNED_INT_2_10_10_10_REV, packed(unsigned(c.x), unsigned(c.y), 0, 0));
    glVertexP3ui(GL_INT_2_10_10_10_REV, packed(unsigned(c.x) + 20, unsigned(c.y), 0, 0));
    glVertexP4ui(GL_UNSIGNED_INT_2_10_10_10_REV, packed(unsigned(c.x) + 10, unsigned(c.y) + 14, 0, 1));
    glEnd();
}

// Draws all primitive types with more than the smallest number of vertices.
void drawPrimitives(int frame) {
    const GLenum kinds[] = {GL_POINTS,         GL_LINES,        GL_LINE_LOOP, GL_LINE_STRIP, GL_TRIANGLES,
                            GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN, GL_QUADS,     GL_QUAD_STRIP, GL_POLYGON};
    Sequence numbers(unsigned(frame) + 7);
    for (int k = 0; k < 10; ++k) {
        const Cell cell = cellOf(80 + k);
        glBegin(kinds[k]);
        for (int i = 0; i < 6; ++i) {
            glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
            glVertex2f(float(cell.x) + float(i / 2) * 9 + numbers.unit(),
                       float(cell.y) + float((i + i / 2) % 2) * 12 + numbers.unit());
        }
        glEnd();
    }
}

void makeTexture() {
    GLuint name = 0;
    glGenTextures(1, &name);
    GLubyte texels[8 * 8 * 3];
    Sequence numbers(3);
    for (GLubyte& texel : texels) {
        texel = numbers.byte();
    }
    for (const GLenum unit : {GL_TEXTURE0, GL_TEXTURE1}) {
        glActiveTexture(unit);
        glBindTexture(GL_TEXTURE_2D, name);
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, 8, 8, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
    glActiveTexture(GL_TEXTURE0);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) { makeTexture(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.1F, 0.15F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            glMatrixMode(GL_MODELVIEW);
            glLoadIdentity();
            if (frame % 2 == 0) {
                drawVertices(frame);
                drawColors(frame);
                drawSecondaryColors(frame);
                drawNormals(frame);
            } else {
                drawTextureCoordinates(frame);
                drawFogCoordinates(frame);
                drawOthers(frame);
                drawPrimitives(frame);
            }
        });
}
