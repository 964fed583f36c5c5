// Fixed function from buffers, in all modes. Nodes draw parts of the large meshes, and leave out most small draws. Some
// meshes reach through the near plane, some primitives are wide, and glBegin draws quads between draws that nodes may
// leave out.
#include <array>
#include <cmath>

#include "tests/programs/culling/meshes.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

struct Mesh {
    GLuint buffer = 0;
    GLsizei count = 0;
};

Mesh triangles, quads, lines, points, strip;
GLuint bytesOfIndices, shorts, words;
constexpr GLsizei kStripColumns = 60, kStripRows = 12, kRestarted = 3 * (2 * kStripColumns + 1);

Mesh meshOf(const std::vector<Vertex>& vertices) {
    return {bufferOf(GL_ARRAY_BUFFER, vertices.size() * sizeof(Vertex), vertices.data()),
            static_cast<GLsizei>(vertices.size())};
}

void setUp(Window&) {
    triangles = meshOf(field(40, 40, 6));
    quads = meshOf(field(24, 24, 4));
    lines = meshOf(field(40, 30, 2));
    points = meshOf(field(40, 40, 1));
    std::vector<Vertex> zigzag;
    std::vector<GLuint> indices;
    for (int row = 0; row < kStripRows; ++row) {
        for (int column = 0; column < kStripColumns; ++column)
            for (int side = 0; side < 2; ++side) {
                Vertex v = field(1, 1, 1)[0];
                v.x = 2.0F * static_cast<float>(column) / kStripColumns - 1;
                v.y = 2.0F * static_cast<float>(row + side) / kStripRows - 1;
                v.colour[0] = static_cast<GLubyte>(20 * row);
                v.colour[1] = static_cast<GLubyte>(4 * column);
                indices.push_back(static_cast<GLuint>(zigzag.size()));
                zigzag.push_back(v);
            }
        indices.push_back(UINT32_MAX);
    }
    strip = meshOf(zigzag);
    words = bufferOf(GL_ELEMENT_ARRAY_BUFFER, indices.size() * 4, indices.data());
    std::vector<GLushort> narrow;
    for (GLushort i = 0; i < 40 * 40 * 6; ++i) narrow.push_back(i);
    shorts = bufferOf(GL_ELEMENT_ARRAY_BUFFER, narrow.size() * 2, narrow.data());
    std::vector<GLubyte> tiny;
    for (int i = 0; i < 240; ++i) tiny.push_back(static_cast<GLubyte>(i));
    bytesOfIndices = bufferOf(GL_ELEMENT_ARRAY_BUFFER, tiny.size(), tiny.data());
}

void use(const Mesh& mesh) {
    glBindBuffer(GL_ARRAY_BUFFER, mesh.buffer);
    glVertexPointer(3, GL_FLOAT, sizeof(Vertex), offsetOf(0));
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), offsetOf(12));
}

// Quads of glBegin beside draws from buffers. The draws in between decide how the driver batches the quads.
void drawSmall(int frame) {
    for (int i = 0; i < 60; ++i) {
        glPushMatrix();
        glTranslatef(1.8F * std::sin(static_cast<float>(i * 7 + frame)), 1.3F * std::cos(static_cast<float>(i * 3)),
                     0.01F * static_cast<float>(i));
        glRotatef(static_cast<float>(20 * i), 0, 0, 1);
        glScalef(0.1F, 0.1F, 0.1F);
        if (i % 3 == 0) {
            glBegin(GL_QUADS);
            for (int corner = 0; corner < 8; ++corner) {
                glColor4ub(static_cast<GLubyte>(30 * corner), static_cast<GLubyte>(4 * i), 200, 140);
                glVertex3f(corner % 4 == 1 || corner % 4 == 2 ? 1 : -1, corner % 4 > 1 ? 1 : -1, corner > 3 ? 0.5F : 0);
            }
            glEnd();
        }
        use(i % 2 ? triangles : quads);
        if (i % 2)
            glDrawArrays(GL_TRIANGLES, 60 * i, 30);
        else
            glDrawArrays(i % 4 ? GL_QUADS : GL_QUAD_STRIP, 40 * (i % 10), 16);
        glPopMatrix();
    }
}

void drawIndexed() {
    use(triangles);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, shorts);
    glDrawElements(GL_TRIANGLES, 40 * 40 * 3, GL_UNSIGNED_SHORT, offsetOf(0));
    glDrawElementsBaseVertex(GL_TRIANGLES, 40 * 40 * 3, GL_UNSIGNED_SHORT, offsetOf(0), 40 * 40 * 3);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, bytesOfIndices);
    for (GLint base = 0; base < 9000; base += 600)
        glDrawElementsBaseVertex(GL_TRIANGLES, 240, GL_UNSIGNED_BYTE, offsetOf(0), base);
    use(strip);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, words);
    glEnable(GL_PRIMITIVE_RESTART);
    glPrimitiveRestartIndex(UINT32_MAX);
    for (int part = 0; part < kStripRows / 3; ++part)
        glDrawRangeElements(GL_TRIANGLE_STRIP, 0, 2 * kStripColumns * kStripRows - 1, kRestarted, GL_UNSIGNED_INT,
                            offsetOf(4 * static_cast<std::size_t>(part) * kRestarted));
    glDisable(GL_PRIMITIVE_RESTART);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 2 * kStripColumns * kStripRows);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

void drawWide(int frame) {
    use(lines);
    glLineWidth(frame % 2 ? 1 : 7);
    glDrawArrays(GL_LINES, 0, lines.count);
    glDrawArrays(GL_LINE_STRIP, 0, lines.count / 2);
    glLineWidth(1);
    use(points);
    glPointSize(9);
    glDrawArrays(GL_POINTS, 0, points.count);
    const std::array<GLfloat, 3> attenuation{0, 0, 0.05F};
    glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, attenuation.data());
    for (GLint first = 0; first < points.count; first += 100) glDrawArrays(GL_POINTS, first, 30);
    const std::array<GLfloat, 3> plain{1, 0, 0};
    glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, plain.data());
    use(triangles);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glDrawArrays(GL_TRIANGLES, 300, 3000);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void draw(Window& window, int frame) {
    const float aspect = static_cast<float>(window.width()) / static_cast<float>(window.height());
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-0.1 * static_cast<double>(aspect), 0.1 * static_cast<double>(aspect), -0.1, 0.1, 0.2, 50);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glTranslatef(0, 0, -2.6F);
    glPushMatrix();
    glRotatef(static_cast<float>(8 * frame), 0.3F, 1, 0.1F);
    use(triangles);
    glDrawArrays(GL_TRIANGLES, 0, triangles.count);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    drawIndexed();
    drawWide(frame);
    glPopMatrix();
    // Through the near plane, and behind the eye.
    glPushMatrix();
    glTranslatef(0.4F, -0.6F, 2.2F);
    glRotatef(80, 1, 0, 0.1F * static_cast<float>(frame));
    glScalef(3, 3, 3);
    use(triangles);
    glShadeModel(GL_FLAT);
    glDrawArrays(GL_TRIANGLES, 0, triangles.count);
    glShadeModel(GL_SMOOTH);
    use(quads);
    glDrawArrays(GL_QUADS, 0, quads.count);
    glPopMatrix();
    drawSmall(frame / 2);
    glDisable(GL_BLEND);
    glDisableClientState(GL_COLOR_ARRAY);
    glDisableClientState(GL_VERTEX_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, WindowSpec{}, setUp, draw); }
