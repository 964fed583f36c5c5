// EXT_separate_shader_objects in OpenGL ES, with function names from eglGetProcAddress.
#include <EGL/egl.h>
#include <GLES2/gl2.h>
#include <GLES2/gl2ext.h>
#include <cstring>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

template <class Function> Function find(const char* name) {
    const auto found = reinterpret_cast<Function>(eglGetProcAddress(name));
    if (!found) fail("%s is not there", name);
    return found;
}

GLuint programs[2], pipelines[2], buffer;

void setUp() {
    const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
    if (!extensions || !std::strstr(extensions, "GL_EXT_separate_shader_objects"))
        fail("GL_EXT_separate_shader_objects is not there");
    const char* vertex[] = {"attribute vec2 place;\n", "uniform vec2 from; varying vec2 at;\nvoid main() { at = place; "
                                                       "gl_Position = vec4(from + place, 0.0, 1.0); }\n"};
    const char* fragment[] = {"precision highp float; uniform vec3 base; varying vec2 at;\nvoid main() { gl_FragColor "
                              "= vec4(base + vec3(at, 0.2), 1.0); }\n"};
    const auto create = find<PFNGLCREATESHADERPROGRAMVEXTPROC>("glCreateShaderProgramvEXT");
    programs[0] = create(GL_VERTEX_SHADER, 2, vertex);
    programs[1] = create(GL_FRAGMENT_SHADER, 1, fragment);
    find<PFNGLGENPROGRAMPIPELINESEXTPROC>("glGenProgramPipelinesEXT")(2, pipelines);
    const auto use = find<PFNGLUSEPROGRAMSTAGESEXTPROC>("glUseProgramStagesEXT");
    use(pipelines[0], GL_VERTEX_SHADER_BIT_EXT, programs[0]);
    use(pipelines[0], GL_FRAGMENT_SHADER_BIT_EXT, programs[1]);
    const GLfloat places[] = {0, 0, 0.7F, 0.1F, 0.1F, 0.8F};
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof places, places, GL_STATIC_DRAW);
    const auto place = static_cast<GLuint>(glGetAttribLocation(programs[0], "place"));
    glVertexAttribPointer(place, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(place);
}

void draw(int frame) {
    find<PFNGLBINDPROGRAMPIPELINEEXTPROC>("glBindProgramPipelineEXT")(pipelines[0]);
    const auto uniform2 = find<PFNGLPROGRAMUNIFORM2FEXTPROC>("glProgramUniform2fEXT");
    const auto uniform3 = find<PFNGLPROGRAMUNIFORM3FEXTPROC>("glProgramUniform3fEXT");
    const GLint from = glGetUniformLocation(programs[0], "from"), base = glGetUniformLocation(programs[1], "base");
    for (int i = 0; i < 3; ++i) {
        uniform2(programs[0], from, -0.9F + 0.5F * float(i), -0.8F + 0.1F * float(frame + i));
        uniform3(programs[1], base, 0.2F * float(i), 0.1F, 0.1F * float(frame));
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    GLint active = 0;
    find<PFNGLACTIVESHADERPROGRAMEXTPROC>("glActiveShaderProgramEXT")(pipelines[0], programs[1]);
    find<PFNGLGETPROGRAMPIPELINEIVEXTPROC>("glGetProgramPipelineivEXT")(pipelines[0], GL_ACTIVE_PROGRAM_EXT, &active);
    showBits(0, active == static_cast<GLint>(programs[1]) ? 1U : 0U);
    glUniform3f(base, 0, 0.5F, 0.5F); // uniform of the active program
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.profile = Profile::Es;
    spec.major = 2;
    return runInEglWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.1F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            draw(frame);
        });
}
