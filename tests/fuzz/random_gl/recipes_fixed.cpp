// Recipes for the fixed function: Begin and End, display lists, feedback, evaluators, pixels at a raster position.
#include <iterator>
#include <vector>

#include "tests/fuzz/random_gl/image_formats.hpp"
#include "tests/fuzz/random_gl/recipes.hpp"

namespace fuzz {
namespace {

constexpr GLenum kModes[] = {GL_POINTS,         GL_LINES,        GL_LINE_LOOP, GL_LINE_STRIP, GL_TRIANGLES,
                             GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN, GL_QUADS,     GL_QUAD_STRIP, GL_POLYGON};

// Returns the families of calls that are valid between glBegin and glEnd.
const std::vector<const Command*>& vertexCommands(const World& w) {
    static std::vector<const Command*> found; // only one profile has them
    if (found.empty()) {
        constexpr std::string_view starts[] = {
            "glVertex2",       "glVertex3",      "glVertex4",   "glColor3",    "glColor4",      "glNormal3",
            "glTexCoord",      "glMaterial",     "glEdgeFlag",  "glFogCoord",  "glIndex",       "glSecondaryColor",
            "glMultiTexCoord", "glVertexAttrib", "glEvalCoord", "glEvalPoint", "glArrayElement"};
        for (const auto& family : w.families()) {
            for (const Command* const command : family) {
                const std::string_view name = command->name;
                const bool pointer =
                    name.find("Pointer") != std::string_view::npos || name.find("Format") != std::string_view::npos ||
                    name.find("Binding") != std::string_view::npos || name.find("Divisor") != std::string_view::npos ||
                    name.find("Array") < name.size() - 12 || name == "glIndexMask";
                for (const std::string_view start : starts) {
                    // Integer vertices are far outside: Mesa's software driver draws other parts of such polygons with
                    // a scissor than without.
                    const bool far = name.starts_with("glVertex") && !name.starts_with("glVertexAttrib") &&
                                     name.find_first_of("is", 8) != std::string_view::npos;
                    if (name.starts_with(start) && !far && (!pointer || name.starts_with("glArrayElement"))) {
                        found.push_back(command);
                    }
                }
            }
        }
    }
    return found;
}

void vertices(World& w) {
    const auto& commands = vertexCommands(w);
    const GLenum mode = w.random.of(kModes);
    if (!w.compilesList) { // vertices after a rejected glBegin are undefined
        (void)w.failed();
        w.insideBegin = true;
        GL(glBegin, mode);
        call(w, "glEnd", glEnd);
        w.insideBegin = false;
        if (w.failed()) {
            return;
        }
    }
    w.insideBegin = true;
    GL(glBegin, mode);
    for (std::uint32_t i = w.random.below(14); i > 0; --i) {
        for (std::uint32_t attribute = w.random.below(3); attribute > 0; --attribute) {
            callCommand(w, *commands[w.random.below(static_cast<std::uint32_t>(commands.size()))]);
        }
        if (w.random.chance(2)) {
            callAny(w);
        }
        GL(glVertex3f, w.random.around(), w.random.around(), w.random.around() * 0.7F);
        w.behindVertex = true;
    }
    call(w, "glEnd", glEnd);
    w.insideBegin = w.behindVertex = false;
    GL(glFlush);
}

void immediate(World& w) {
    if (w.random.chance(30)) {
        calm(w);
    }
    vertices(w);
}

GLuint listName(World& w) {
    GLuint list = w.living(Kind::List);
    if (list == 0 || w.random.chance(40)) {
        list = GL(glGenLists, 1);
        w.keep(Kind::List, list);
    }
    return list;
}

// Compiles a list. It calls only lists with smaller names, so there are no cycles.
void compileList(World& w) {
    const GLuint list = listName(w);
    useNoGeometryShader(w);
    GL(glNewList, list, w.random.chance(50) ? GL_COMPILE : GL_COMPILE_AND_EXECUTE);
    w.compilesList = true;
    for (std::uint32_t i = w.random.below(8); i > 0; --i) {
        const std::uint32_t dice = w.random.below(10);
        const GLuint other = w.living(Kind::List);
        if (dice < 2 && other < list) {
            GL(glCallList, other);
        } else if (dice < 5) {
            vertices(w);
        } else {
            callAny(w);
        }
    }
    GL(glEndList);
    w.compilesList = false;
}

void runLists(World& w) {
    useNoGeometryShader(w);
    if (w.random.chance(60)) {
        GL(glCallList, w.name(Kind::List));
        return;
    }
    const GLuint base = w.random.below(3);
    GL(glListBase, base);
    GLubyte names[4];
    for (GLubyte& name : names) {
        name = static_cast<GLubyte>(w.living(Kind::List) - base);
    }
    constexpr GLenum types[] = {GL_UNSIGNED_BYTE, GL_BYTE};
    GL(glCallLists, w.random.between(0, 4), w.random.of(types), names);
    GL(glListBase, 0U);
}

void feedback(World& w) {
    constexpr GLenum kinds[] = {GL_2D, GL_3D, GL_3D_COLOR, GL_3D_COLOR_TEXTURE, GL_4D_COLOR_TEXTURE};
    const std::size_t bytes = 8192;
    void* const memory = lateMemory(bytes);
    const bool selects = w.random.chance(50);
    GL(glShadeModel, GL_SMOOTH); // with flat shading Mesa 22.3.6 gives clipped vertices colours of uninitialised memory
    if (selects) {
        GL(glSelectBuffer, w.random.chance(80) ? 1000 : 9, static_cast<GLuint*>(memory));
    } else {
        GL(glFeedbackBuffer, w.random.chance(80) ? 1000 : 30, w.random.of(kinds), static_cast<GLfloat*>(memory));
    }
    GL(glRenderMode, selects ? GL_SELECT : GL_FEEDBACK);
    if (selects) {
        GL(glInitNames);
        GL(glPushName, w.random.below(9));
    }
    for (std::uint32_t i = w.random.below(4); i > 0; --i) {
        vertices(w);
        selects ? GL(glLoadName, w.random.below(100)) : GL(glPassThrough, 3.0F);
    }
    w.observe(static_cast<std::uint64_t>(GL(glRenderMode, GL_RENDER)));
    w.observe(memory, bytes);
}

void matrices(World& w) {
    constexpr GLenum modes[] = {GL_MODELVIEW, GL_MODELVIEW, GL_PROJECTION, GL_TEXTURE};
    GL(glMatrixMode, w.random.of(modes));
    switch (w.random.below(6)) {
    case 0: GL(glLoadIdentity); break;
    case 1: GL(glTranslatef, w.random.around() * 0.4F, w.random.around() * 0.4F, 0.0F); break;
    case 2: GL(glRotatef, w.random.around() * 90.0F, 0.0F, w.random.around(), 1.0F); break;
    case 3: GL(glScalef, 0.5F + w.random.unit(), 0.5F + w.random.unit(), 0.9F); break;
    case 4: GL(glPushMatrix); break;
    default: GL(glPopMatrix);
    }
}

void rasterPixels(World& w) {
    if (w.random.chance(50)) {
        calm(w);
    }
    if (w.random.chance(50)) {
        GL(glWindowPos2i, w.random.between(-6, 60), w.random.between(-6, 45));
    } else {
        GL(glRasterPos3f, w.random.around(), w.random.around(), w.random.around() * 0.5F);
    }
    if (w.random.chance(20)) {
        GL(glPixelZoom, w.random.around() * 2.0F, w.random.around() * 2.0F);
    }
    GL(glBindBuffer, GL_PIXEL_UNPACK_BUFFER, 0);
    const int width = w.random.between(0, 24);
    const int height = w.random.between(0, 20);
    const ImageFormat& image = anyFormat(w);
    const void* const pixels = inputOf(image.type == GL_FLOAT ? Type::Float : Type::Byte, w.random);
    switch (w.random.below(4)) {
    case 0: GL(glDrawPixels, width, height, image.format, image.type, pixels); break;
    case 1: GL(glDrawPixels, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels); break;
    case 2:
        GL(glBitmap, width, height, w.random.around() * 4.0F, 0.0F, w.random.around() * 9.0F, 1.0F,
           static_cast<const GLubyte*>(inputOf(Type::Byte, w.random)));
        break;
    default: {
        constexpr GLenum kinds[] = {GL_COLOR, GL_COLOR, GL_DEPTH, GL_STENCIL};
        GL(glCopyPixels, w.random.between(-4, 50), w.random.between(-4, 40), width, height, w.random.of(kinds));
    }
    }
}

void evaluator(World& w) {
    const auto* const points = static_cast<const float*>(inputOf(Type::Float, w.random));
    GL(glMap2f, w.random.chance(50) ? GL_MAP2_VERTEX_3 : GL_MAP2_COLOR_4, 0.0F, 1.0F, 4, w.random.between(1, 3), 0.0F,
       1.0F, 16, w.random.between(1, 3), points);
    GL(glMap1f, GL_MAP1_VERTEX_3, 0.0F, 1.0F, 3, w.random.between(2, 4), points);
    GL(glEnable, w.random.chance(50) ? GL_MAP2_VERTEX_3 : GL_MAP1_VERTEX_3);
    GL(glMapGrid2f, 4, 0.0F, 1.0F, 3, 0.0F, 1.0F);
    GL(glMapGrid1f, 5, 0.0F, 1.0F);
    constexpr GLenum modes[] = {GL_FILL, GL_LINE, GL_POINT};
    GL(glEvalMesh2, w.random.of(modes), 0, 4, 0, 3);
    GL(glEvalMesh1, GL_LINE, 0, 5);
}

void lights(World& w) {
    w.random.chance(60) ? GL(glEnable, GL_LIGHTING) : GL(glDisable, GL_LIGHTING);
    GL(glEnable, GL_LIGHT0 + w.random.below(3));
    const auto* const values = static_cast<const float*>(inputOf(Type::Float, w.random));
    GL(glLightfv, GL_LIGHT0 + w.random.below(3), w.random.chance(50) ? GL_DIFFUSE : GL_POSITION, values);
    GL(glMaterialfv, GL_FRONT_AND_BACK, GL_AMBIENT, values);
    w.random.chance(50) ? GL(glEnable, GL_COLOR_MATERIAL) : GL(glDisable, GL_COLOR_MATERIAL);
}

void stacks(World& w) {
    switch (w.random.below(4)) {
    case 0: GL(glPushAttrib, w.random.chance(60) ? GL_ALL_ATTRIB_BITS : w.random.next() & 0xfffffU); break;
    case 1: // a primitive applies current values: otherwise Mesa repeats values set before a pop at the next flush
        GL(glBegin, GL_POINTS), GL(glEnd);
        GL(glPopAttrib);
        break;
    case 2: GL(glPushClientAttrib, w.random.chance(60) ? GL_CLIENT_ALL_ATTRIB_BITS : w.random.below(4)); break;
    default: GL(glPopClientAttrib);
    }
}

constexpr Recipe kRecipes[] = {
    {"begin and end", immediate, "c", 12}, {"list", compileList, "c", 6},   {"call lists", runLists, "c", 6},
    {"feedback", feedback, "c", 3},        {"matrices", matrices, "c1", 8}, {"pixels", rasterPixels, "c", 8},
    {"evaluator", evaluator, "c", 3},      {"lights", lights, "c1", 4},     {"stacks", stacks, "c", 6},
};

} // namespace

std::span<const Recipe> fixedRecipes() { return kRecipes; }

} // namespace fuzz
