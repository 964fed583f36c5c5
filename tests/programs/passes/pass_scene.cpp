// One scene in perspective and an overlay without, with every way to set the projection in OpenGL (--draw).
#include "tests/programs/passes/pass_options.hpp"
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

using namespace programs;

namespace {

PassOptions options;
GLuint program = 0, quads = 0;
GLuint framebuffer = 0, picture = 0, shadowFramebuffer = 0, shadow = 0, block = 0;
constexpr int kShadowSize = 64;

const char* const kFragment = "#version 330\nin vec3 tint; out vec4 result; void main() { result = vec4(tint, 1); }\n";
const char* const kHead =
    "#version 400\nlayout(location = 0) in vec3 place; layout(location = 1) in vec3 tone; out vec3 tint;\n";

struct Way {
    std::string vertex;
    const char* geometry = nullptr;
    bool tessellated = false;
};

const std::map<std::string, Way>& ways() {
    static const std::string head = kHead;
    static const std::string byMatrix =
        head + "uniform mat4 whole; void main() { tint = tone; gl_Position = whole * vec4(place, 1); }\n";
    static const std::map<std::string, Way> all = {
        {"legacy",
         {"#version 110\nattribute vec3 place; attribute vec3 tone; varying vec3 tint; void main() { tint = tone; "
          "gl_Position = gl_ModelViewProjectionMatrix * vec4(place, 1.0); }\n"}},
        {"matrices",
         {head + "uniform mat4 projection, modelView; void main() { tint = tone; gl_Position = projection * (modelView "
                 "* vec4(place, 1)); }\n"}},
        {"mvp", {byMatrix}},
        {"block",
         {head + "layout(std140) uniform Views { mat4 projection; mat4 modelView; }; void main() { tint = tone; "
                 "gl_Position = projection * (modelView * vec4(place, 1)); }\n"}},
        {"geometry",
         {"#version 330\nlayout(location = 0) in vec3 place; layout(location = 1) in vec3 tone; out vec3 color; "
          "uniform mat4 whole; void main() { color = tone; gl_Position = whole * vec4(place, 1); }\n",
          "#version 330\nlayout(triangles) in; layout(triangle_strip, max_vertices = 3) out; in vec3 color[]; out vec3 "
          "tint;\n"
          "void main() { for (int i = 0; i < 3; ++i) { gl_Position = gl_in[i].gl_Position; tint = color[2 - i]; "
          "EmitVertex(); } EndPrimitive(); }\n"}},
        {"tessellation",
         {"#version 400\nlayout(location = 0) in vec3 place; layout(location = 1) in vec3 tone; out vec3 color; "
          "uniform mat4 whole; void main() { color = tone; gl_Position = whole * vec4(place, 1); }\n",
          nullptr, true}},
        {"framebuffer", {byMatrix}},
        {"blit", {byMatrix}},
    };
    return all;
}

const char* const kControl =
    "#version 400\nlayout(vertices = 3) out; in vec3 color[]; out vec3 shade[];\n"
    "void main() { gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position; shade[gl_InvocationID] = "
    "color[gl_InvocationID];\n"
    "gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 2.0; gl_TessLevelInner[0] = 2.0; }\n";
const char* const kEvaluation = "#version 400\nlayout(triangles, equal_spacing, ccw) in; in vec3 shade[]; out vec3 "
                                "tint; void main() { vec3 t = gl_TessCoord;\n"
                                "gl_Position = t.x * gl_in[0].gl_Position + t.y * gl_in[1].gl_Position + t.z * "
                                "gl_in[2].gl_Position; tint = t.x * shade[0] + t.y * shade[1] + t.z * shade[2]; }\n";

bool intoFramebuffer() { return options.draw == "framebuffer" || options.draw == "blit"; }

GLuint makeFramebuffer(int width, int height, GLuint& colour) {
    GLuint made = 0, depth = 0;
    glGenTextures(1, &colour);
    glBindTexture(GL_TEXTURE_2D, colour);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenRenderbuffers(1, &depth);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    glGenFramebuffers(1, &made);
    glBindFramebuffer(GL_FRAMEBUFFER, made);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail("the framebuffer is incomplete");
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return made;
}

bool byFixedFunction() { return options.draw == "fixed" || options.draw == "textured"; }

// Makes a texture with a colour per level.
void makeLevels() {
    constexpr int kLevels = 8;
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    for (int level = 0; level < kLevels; ++level) {
        const int size = 1 << (kLevels - 1 - level);
        std::vector<unsigned char> texels(static_cast<size_t>(size) * static_cast<size_t>(size) * 4, 255);
        for (size_t i = 0; i < texels.size(); i += 4)
            texels[i] = static_cast<unsigned char>(level * 36),
            texels[i + 1] = static_cast<unsigned char>(255 - level * 20);
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
}

void drawGround() {
    glEnable(GL_TEXTURE_2D);
    glColor3f(1, 1, 1);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex3f(-8, -1, 8);
    glTexCoord2f(16, 0), glVertex3f(8, -1, 8);
    glTexCoord2f(16, 16), glVertex3f(8, -1, -8);
    glTexCoord2f(0, 16), glVertex3f(-8, -1, -8);
    glEnd();
    glDisable(GL_TEXTURE_2D);
}

void setUp(const Window& window) {
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 24, sceneVertices());
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 24, sceneVertices() + 3);
    if (options.draw == "textured") makeLevels();
    if (byFixedFunction()) return;
    const auto way = ways().find(options.draw);
    if (way == ways().end()) fail("unknown way to draw \"%s\"", options.draw.c_str());
    const char* vertex = way->second.vertex.c_str();
    const auto bind = [](unsigned p) { glBindAttribLocation(p, 0, "place"), glBindAttribLocation(p, 1, "tone"); };
    if (options.draw == "legacy")
        program = buildProgram({{GL_VERTEX_SHADER, vertex},
                                {GL_FRAGMENT_SHADER,
                                 "#version 110\nvarying vec3 tint; void main() { gl_FragColor = vec4(tint, 1.0); }\n"}},
                               bind);
    else if (way->second.geometry)
        program = buildProgram(
            {{GL_VERTEX_SHADER, vertex}, {GL_GEOMETRY_SHADER, way->second.geometry}, {GL_FRAGMENT_SHADER, kFragment}});
    else if (way->second.tessellated)
        program = buildProgram({{GL_VERTEX_SHADER, vertex},
                                {GL_TESS_CONTROL_SHADER, kControl},
                                {GL_TESS_EVALUATION_SHADER, kEvaluation},
                                {GL_FRAGMENT_SHADER, kFragment}});
    else
        program = buildProgram({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, kFragment}});
    quads = buildProgram(
        {{GL_VERTEX_SHADER, "#version 330\nuniform vec4 box; out vec2 at; void main() { at = vec2(gl_VertexID & 1, "
                            "gl_VertexID >> 1); gl_Position = vec4(mix(box.xy, box.zw, at), 0, 1); }\n"},
         {GL_FRAGMENT_SHADER, "#version 330\nin vec2 at; uniform sampler2D image; uniform int plain; out vec4 result;\n"
                              "void main() { result = plain != 0 ? vec4(at, 0.5, 1) : texture(image, at); }\n"}});
    glGenBuffers(1, &block);
    if (!intoFramebuffer()) return;
    framebuffer = makeFramebuffer(window.width(), window.height(), picture);
    shadowFramebuffer = makeFramebuffer(kShadowSize, kShadowSize, shadow);
}

void moveViewport(const Window& window, bool moved) {
    glViewportIndexedf(0, moved ? options.moveX : 0, moved ? options.moveY : 0, float(window.width()),
                       float(window.height()));
}

void drawScene(const Window& window, int frame) {
    const Matrix projection = projectionOf(options, window.width(), window.height()),
                 modelView = modelViewOf(options, frame);
    const Matrix whole = multiply(projection, modelView);
    glEnable(GL_DEPTH_TEST);
    if (byFixedFunction() || options.draw == "legacy") {
        glMatrixMode(GL_PROJECTION);
        glLoadMatrixf(projection.data());
        glMatrixMode(GL_MODELVIEW);
        glLoadMatrixf(modelView.data());
    }
    if (options.draw == "textured") drawGround();
    if (byFixedFunction()) {
        glVertexPointer(3, GL_FLOAT, 24, sceneVertices());
        glColorPointer(3, GL_FLOAT, 24, sceneVertices() + 3);
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnableClientState(GL_COLOR_ARRAY);
        glDrawArrays(GL_TRIANGLES, 0, kSceneVertices);
        glDisableClientState(GL_VERTEX_ARRAY);
        glDisableClientState(GL_COLOR_ARRAY);
        return;
    }
    glUseProgram(program);
    const auto set = [](const char* name, const Matrix& m) {
        glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, m.data());
    };
    if (options.draw == "matrices")
        set("projection", projection), set("modelView", modelView);
    else if (options.draw == "block") {
        float values[32];
        std::copy(projection.begin(), projection.end(), values);
        std::copy(modelView.begin(), modelView.end(), values + 16);
        glBindBuffer(GL_UNIFORM_BUFFER, block);
        glBufferData(GL_UNIFORM_BUFFER, sizeof values, values, GL_DYNAMIC_DRAW);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, block);
    } else if (options.draw != "legacy")
        set("whole", whole);
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    if (options.draw == "tessellation") glPatchParameteri(GL_PATCH_VERTICES, 3);
    glDrawArrays(options.draw == "tessellation" ? GL_PATCHES : GL_TRIANGLES, 0, kSceneVertices);
    glDisableVertexAttribArray(0);
    glDisableVertexAttribArray(1);
    glUseProgram(0);
}

void drawQuad(float x0, float y0, float x1, float y1, GLuint texture) {
    glDisable(GL_DEPTH_TEST);
    glUseProgram(quads);
    glBindTexture(GL_TEXTURE_2D, texture);
    glUniform4f(glGetUniformLocation(quads, "box"), x0, y0, x1, y1);
    glUniform1i(glGetUniformLocation(quads, "plain"), texture == 0);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glUseProgram(0);
}

// Draws the lower left quarter of the window, without perspective.
void drawOverlay() {
    if (!byFixedFunction()) return drawQuad(-1, -1, 0, 0, 0);
    glDisable(GL_DEPTH_TEST);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(0, 2, 0, 2, -1, 1);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glBegin(GL_QUADS);
    glColor3f(0, 0, 0.5F), glVertex2f(0, 0);
    glColor3f(1, 0, 0.5F), glVertex2f(1, 0);
    glColor3f(1, 1, 0.5F), glVertex2f(1, 1);
    glColor3f(0, 1, 0.5F), glVertex2f(0, 1);
    glEnd();
}

void clearAll() {
    glClearColor(0.1F, 0.15F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

// Draws the scene as seen from a light: the same for every eye.
void drawShadow(const Window& window, int frame) {
    const PassOptions seen = options;
    options.eye = 0;
    glBindFramebuffer(GL_FRAMEBUFFER, shadowFramebuffer);
    glViewport(0, 0, kShadowSize, kShadowSize);
    clearAll();
    drawScene(window, frame + 20);
    options = seen;
}

void draw(const Window& window, int frame) {
    if (!intoFramebuffer()) {
        moveViewport(window, true);
        clearAll();
        drawScene(window, frame);
        return drawOverlay();
    }
    drawShadow(window, frame);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    moveViewport(window, true);
    clearAll();
    drawScene(window, frame);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    moveViewport(window, false);
    clearAll();
    if (options.draw == "blit")
        glBlitFramebuffer(0, 0, window.width(), window.height(), 0, 0, window.width(), window.height(),
                          GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (options.draw == "framebuffer") drawQuad(-1, -1, 1, 1, picture);
    drawQuad(0.5F, 0.5F, 1, 1, shadow);
    drawOverlay();
}

} // namespace

int main(int argc, char** argv) {
    options = takePassOptions(argc, argv);
    return runInGlxWindow(
        argc, argv, {}, [](Window& window) { setUp(window); }, [](Window& window, int frame) { draw(window, frame); });
}
