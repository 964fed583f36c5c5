#include "tests/programs/routes/scene.hpp"

#include <GL/gl.h>
#include <GL/glext.h>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

namespace programs {

struct Scene::Functions {
    FindFunction find;
    template <class T> T get(const char* name) const {
        const GlFunction found = find(name);
        if (found == nullptr) {
            fail("this way to OpenGL has no %s", name);
        }
        return reinterpret_cast<T>(found);
    }
#define MURAL_SCENE_FUNCTION(name) decltype(&::gl##name) name = get<decltype(&::gl##name)>("gl" #name)
#define MURAL_SCENE_EXTENSION(name, type) type name = get<type>("gl" #name)
    MURAL_SCENE_FUNCTION(Begin);
    MURAL_SCENE_FUNCTION(BindTexture);
    MURAL_SCENE_FUNCTION(Clear);
    MURAL_SCENE_FUNCTION(ClearColor);
    MURAL_SCENE_FUNCTION(Color3f);
    MURAL_SCENE_FUNCTION(Disable);
    MURAL_SCENE_FUNCTION(DrawArrays);
    MURAL_SCENE_FUNCTION(Enable);
    MURAL_SCENE_FUNCTION(End);
    MURAL_SCENE_FUNCTION(GenTextures);
    MURAL_SCENE_FUNCTION(GetError);
    MURAL_SCENE_FUNCTION(LoadIdentity);
    MURAL_SCENE_FUNCTION(Rotatef);
    MURAL_SCENE_FUNCTION(TexCoord2f);
    MURAL_SCENE_FUNCTION(TexImage2D);
    MURAL_SCENE_FUNCTION(TexParameteri);
    MURAL_SCENE_FUNCTION(Vertex2f);
    MURAL_SCENE_FUNCTION(Viewport);
    MURAL_SCENE_EXTENSION(ActiveTexture, PFNGLACTIVETEXTUREPROC);
    MURAL_SCENE_EXTENSION(AttachShader, PFNGLATTACHSHADERPROC);
    MURAL_SCENE_EXTENSION(BindAttribLocation, PFNGLBINDATTRIBLOCATIONPROC);
    MURAL_SCENE_EXTENSION(BindBuffer, PFNGLBINDBUFFERPROC);
    MURAL_SCENE_EXTENSION(BufferData, PFNGLBUFFERDATAPROC);
    MURAL_SCENE_EXTENSION(CompileShader, PFNGLCOMPILESHADERPROC);
    MURAL_SCENE_EXTENSION(CreateProgram, PFNGLCREATEPROGRAMPROC);
    MURAL_SCENE_EXTENSION(CreateShader, PFNGLCREATESHADERPROC);
    MURAL_SCENE_EXTENSION(DisableVertexAttribArray, PFNGLDISABLEVERTEXATTRIBARRAYPROC);
    MURAL_SCENE_EXTENSION(EnableVertexAttribArray, PFNGLENABLEVERTEXATTRIBARRAYPROC);
    MURAL_SCENE_EXTENSION(GenBuffers, PFNGLGENBUFFERSPROC);
    MURAL_SCENE_EXTENSION(GetUniformLocation, PFNGLGETUNIFORMLOCATIONPROC);
    MURAL_SCENE_EXTENSION(LinkProgram, PFNGLLINKPROGRAMPROC);
    MURAL_SCENE_EXTENSION(ShaderSource, PFNGLSHADERSOURCEPROC);
    MURAL_SCENE_EXTENSION(Uniform1f, PFNGLUNIFORM1FPROC);
    MURAL_SCENE_EXTENSION(UseProgram, PFNGLUSEPROGRAMPROC);
    MURAL_SCENE_EXTENSION(VertexAttribPointer, PFNGLVERTEXATTRIBPOINTERPROC);
#undef MURAL_SCENE_FUNCTION
#undef MURAL_SCENE_EXTENSION
};

Scene::Scene(FindFunction find) : gl_(new Functions{find}) { makeObjects(); }
Scene::~Scene() { delete gl_; }

void Scene::makeObjects() {
    const char* const sources[] = {
        "attribute vec2 place; varying vec2 at; uniform float turn; void main() { at = place;\n"
        "gl_Position = vec4(place.x + 0.1 * sin(turn + place.y * 4.0), place.y, 0.0, 1.0); }\n",
        "varying vec2 at; void main() { gl_FragColor = vec4(at * 0.5 + 0.5, fract(gl_FragCoord.x / 16.0), 1.0); }\n"};
    program_ = gl_->CreateProgram();
    for (int i = 0; i < 2; ++i) {
        const GLuint shader = gl_->CreateShader(i == 0 ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER);
        gl_->ShaderSource(shader, 1, &sources[i], nullptr);
        gl_->CompileShader(shader);
        gl_->AttachShader(program_, shader);
    }
    gl_->BindAttribLocation(program_, 0, "place");
    gl_->LinkProgram(program_);
    const GLfloat places[] = {-0.9F, -0.8F, 0.1F, -0.9F, -0.5F, 0.2F, 0.2F, 0.1F};
    gl_->GenBuffers(1, &buffer_);
    gl_->BindBuffer(GL_ARRAY_BUFFER, buffer_);
    gl_->BufferData(GL_ARRAY_BUFFER, sizeof places, places, GL_STATIC_DRAW);
    gl_->BindBuffer(GL_ARRAY_BUFFER, 0);
    GLubyte texels[8 * 8 * 3];
    Sequence numbers(17);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    gl_->GenTextures(1, &texture_);
    gl_->BindTexture(GL_TEXTURE_2D, texture_);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 8, 8, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
}

void Scene::draw(int frame, int width, int height) {
    gl_->Viewport(0, 0, width, height);
    gl_->ClearColor(0.1F, 0.05F * float(frame % 10), 0.15F, 1);
    gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl_->UseProgram(program_);
    gl_->Uniform1f(gl_->GetUniformLocation(program_, "turn"), float(frame) * 0.6F);
    gl_->BindBuffer(GL_ARRAY_BUFFER, buffer_);
    gl_->VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_->EnableVertexAttribArray(0);
    gl_->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    gl_->DisableVertexAttribArray(0);
    gl_->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl_->UseProgram(0);
    gl_->ActiveTexture(GL_TEXTURE0);
    gl_->Enable(GL_TEXTURE_2D);
    gl_->LoadIdentity();
    gl_->Rotatef(float(frame) * 9, 0, 0, 1);
    gl_->Begin(GL_QUADS);
    const GLfloat corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const auto& corner : corners) {
        gl_->Color3f(1, corner[0], corner[1]);
        gl_->TexCoord2f(corner[0] * 2, corner[1]);
        gl_->Vertex2f(0.1F + corner[0] * 0.6F, 0.1F + corner[1] * 0.5F);
    }
    gl_->End();
    gl_->Disable(GL_TEXTURE_2D);
    const GLenum error = gl_->GetError();
    if (error != GL_NO_ERROR) {
        fail("GL error 0x%04x in frame %d", error, frame);
    }
}

} // namespace programs
