// GLSL 1.10 to 1.50 in the style of older programs:
//   - built-in attributes, varyings and state;
//   - the ARB entry points (handles instead of names), generic attributes bound before the link;
//   - two-sided colours, point sprites;
//   - mixtures of a shader and a fixed-function stage, several shaders of one stage.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLhandleARB arbProgram;
GLuint lit, vertexOnly, fragmentOnly, sprites, twoSided, linked, varied;
GLuint texture;

GLhandleARB buildArbProgram() {
    const char* sources[2] = {
        "uniform float shift; varying vec3 tint;\n",
        "void main() { tint = gl_Color.rgb;\n"
        "gl_Position = gl_ModelViewProjectionMatrix * (gl_Vertex + vec4(shift, 0.0, 0.0, 0.0)); }\n"};
    const GLint lengths[2] = {-1, -1};
    const char* fragment = "varying vec3 tint; uniform vec4 factor;\n"
                           "void main() { gl_FragColor = vec4(tint, 1.0) * factor; }\n";
    const GLhandleARB vertexShader = glCreateShaderObjectARB(GL_VERTEX_SHADER_ARB);
    const GLhandleARB fragmentShader = glCreateShaderObjectARB(GL_FRAGMENT_SHADER_ARB);
    glShaderSourceARB(vertexShader, 2, sources, lengths);
    glShaderSourceARB(fragmentShader, 1, &fragment, nullptr);
    glCompileShaderARB(vertexShader);
    glCompileShaderARB(fragmentShader);
    const GLhandleARB program = glCreateProgramObjectARB();
    glAttachObjectARB(program, vertexShader);
    glAttachObjectARB(program, fragmentShader);
    glLinkProgramARB(program);
    GLint isLinked = 0;
    glGetObjectParameterivARB(program, GL_OBJECT_LINK_STATUS_ARB, &isLinked);
    if (isLinked == 0) {
        fail("the ARB program does not link");
    }
    glDeleteObjectARB(vertexShader);
    glDeleteObjectARB(fragmentShader);
    return program;
}

void makePrograms() {
    arbProgram = buildArbProgram();
    lit = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 110\nvarying vec4 tint; void main() {\n"
          "vec3 n = normalize(gl_NormalMatrix * gl_Normal); vec4 p = gl_ModelViewMatrix * gl_Vertex;\n"
          "vec3 l = normalize(gl_LightSource[1].position.xyz - p.xyz);\n"
          "tint = gl_FrontMaterial.diffuse * max(dot(n, l), 0.0) + gl_LightModel.ambient;\n"
          "gl_TexCoord[0] = gl_TextureMatrix[0] * gl_MultiTexCoord0; gl_FogFragCoord = gl_Vertex.x;\n"
          "gl_Position = ftransform(); }\n"},
         {GL_FRAGMENT_SHADER, "#version 110\nuniform sampler2D image; varying vec4 tint; void main() {\n"
                              "float f = clamp((gl_Fog.end - gl_FogFragCoord) * gl_Fog.scale, 0.0, 1.0);\n"
                              "gl_FragColor = mix(gl_Fog.color, tint * texture2D(image, gl_TexCoord[0].st), f); }\n"}});
    vertexOnly = buildProgram(
        {{GL_VERTEX_SHADER, "#version 120\nattribute float bend; void main() { vec4 p = gl_Vertex;\n"
                            "p.y += bend * sin(p.x * 0.2); gl_FrontColor = gl_Color.gbra;\n"
                            "gl_TexCoord[0] = gl_MultiTexCoord0; gl_Position = gl_ModelViewProjectionMatrix * p; }\n"}},
        [](unsigned program) { glBindAttribLocation(program, 6, "bend"); });
    fragmentOnly =
        buildProgram({{GL_FRAGMENT_SHADER, "#version 120\nuniform mat2x3 weights; void main() {\n"
                                           "gl_FragColor = vec4(weights * gl_TexCoord[0].st, 1.0) * gl_Color;\n"
                                           "if (mod(gl_FragCoord.x + gl_FragCoord.y, 4.0) < 1.0) discard; }\n"}});
    sprites =
        buildProgram({{GL_VERTEX_SHADER, "#version 120\nvoid main() { gl_FrontColor = gl_Color;\n"
                                         "gl_PointSize = 6.0 + gl_Vertex.z * 20.0; gl_Position = ftransform(); }\n"},
                      {GL_FRAGMENT_SHADER,
                       "#version 120\nvoid main() { vec2 c = gl_PointCoord - vec2(0.5);\n"
                       "if (dot(c, c) > 0.25) discard; gl_FragColor = vec4(gl_PointCoord, 0, 1) * gl_Color; }\n"}});
    twoSided = buildProgram(
        {{GL_VERTEX_SHADER, "#version 120\nvoid main() { gl_FrontColor = gl_Color; gl_BackColor = gl_Color.brga;\n"
                            "gl_Position = ftransform(); }\n"},
         {GL_FRAGMENT_SHADER,
          "#version 120\nvoid main() { gl_FragColor = gl_FrontFacing ? gl_Color : gl_Color * 0.6; }\n"}});
    // A function in a second shader of the same stage.
    linked = buildProgram(
        {{GL_VERTEX_SHADER, "#version 130\nvec4 place(vec4 v); out vec3 tint; void main() { tint = gl_Color.rgb;\n"
                            "gl_Position = gl_ModelViewProjectionMatrix * place(gl_Vertex); }\n"},
         {GL_VERTEX_SHADER, "#version 130\nuniform float angle; vec4 place(vec4 v) {\n"
                            "return v + vec4(sin(angle + v.y * 0.1) * 6.0, 0, 0, 0); }\n"},
         {GL_FRAGMENT_SHADER, "#version 130\nin vec3 tint; out vec4 first; void main() { first = vec4(tint, 1); }\n"}},
        [](unsigned program) { glBindFragDataLocation(program, 0, "first"); });
    varied = buildProgram(
        {{GL_VERTEX_SHADER, "#version 150 compatibility\nflat out vec3 flatTint; noperspective out vec3 linear;\n"
                            "smooth out vec3 curved; void main() { flatTint = linear = curved = gl_Color.rgb;\n"
                            "gl_Position = ftransform(); gl_Position *= 1.0 + gl_Color.r; }\n"},
         {GL_FRAGMENT_SHADER, "#version 150 compatibility\nflat in vec3 flatTint; noperspective in vec3 linear;\n"
                              "smooth in vec3 curved; out vec4 result; void main() {\n"
                              "result = vec4(flatTint.r, linear.g, curved.b, 1) + vec4(fwidth(curved), 0); }\n"}});
}

void strip(float x, float y, GLint bend = -1) {
    glBegin(GL_TRIANGLE_STRIP);
    for (int i = 0; i < 14; ++i) {
        Sequence numbers{unsigned(i)};
        if (bend >= 0) {
            glVertexAttrib1f(GLuint(bend), float(i));
        }
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glNormal3f(numbers.unit() - 0.5F, numbers.unit() - 0.5F, 1);
        glTexCoord2f(float(i) * 0.3F, float(i % 2));
        glVertex3f(x + float(i / 2) * 11, y + float(i % 2) * 35, numbers.unit() * 0.5F);
    }
    glEnd();
}

void drawOld(int frame) {
    glUseProgramObjectARB(arbProgram);
    glUniform1fARB(glGetUniformLocationARB(arbProgram, "shift"), float(frame) * 2);
    const GLfloat factor[] = {1, 0.6F, 0.2F * float(frame), 1};
    glUniform4fvARB(glGetUniformLocationARB(arbProgram, "factor"), 1, factor);
    strip(5, 5);
    glUseProgramObjectARB(0);
    const GLfloat place[] = {40, 60, 30, 1};
    const GLfloat fog[] = {0.4F, 0.1F * float(frame), 0.2F, 1};
    glLightfv(GL_LIGHT1, GL_POSITION, place);
    glFogfv(GL_FOG_COLOR, fog);
    glFogf(GL_FOG_START, 80);
    glFogf(GL_FOG_END, 190);
    glMatrixMode(GL_TEXTURE);
    glLoadIdentity();
    glRotatef(float(frame) * 15, 0, 0, 1);
    glMatrixMode(GL_MODELVIEW);
    glUseProgram(lit);
    glUniform1i(glGetUniformLocation(lit, "image"), 0);
    strip(90, 5);
    glMatrixMode(GL_TEXTURE);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
}

void drawMixed(int frame) {
    glUseProgram(vertexOnly);
    glEnable(GL_TEXTURE_2D);
    strip(5, 50, glGetAttribLocation(vertexOnly, "bend"));
    glDisable(GL_TEXTURE_2D);
    glUseProgram(fragmentOnly);
    const GLfloat weights[] = {1, 0.2F, 0.3F * float(frame), 0, 1, 0.5F};
    glUniformMatrix2x3fv(glGetUniformLocation(fragmentOnly, "weights"), 1, GL_FALSE, weights);
    strip(90, 50);
    glUseProgram(twoSided);
    glEnable(GL_VERTEX_PROGRAM_TWO_SIDE);
    glFrontFace(frame % 2 == 0 ? GL_CCW : GL_CW);
    strip(170, 5);
    glFrontFace(GL_CCW);
    glDisable(GL_VERTEX_PROGRAM_TWO_SIDE);
    glUseProgram(sprites);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glEnable(GL_POINT_SPRITE);
    glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, frame % 2 == 0 ? GL_UPPER_LEFT : GL_LOWER_LEFT);
    glBegin(GL_POINTS);
    for (int i = 0; i < 5; ++i) {
        glColor3f(1, 0.2F * float(i), 1);
        glVertex3f(175 + float(i) * 14, 70, 0.15F * float(i));
    }
    glEnd();
    glDisable(GL_PROGRAM_POINT_SIZE);
    // Fixed-function sprites.
    glUseProgram(0);
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_POINT_SPRITE, GL_COORD_REPLACE, GL_TRUE);
    glPointSize(13);
    glBegin(GL_POINTS);
    for (int i = 0; i < 5; ++i) {
        glVertex2f(20.3F + float(i) * 17, 110);
    }
    glEnd();
    glTexEnvi(GL_POINT_SPRITE, GL_COORD_REPLACE, GL_FALSE);
    glDisable(GL_POINT_SPRITE);
    glDisable(GL_TEXTURE_2D);
    glPointSize(1);
}

void drawNewer(int frame) {
    glUseProgram(linked);
    glUniform1f(glGetUniformLocation(linked, "angle"), float(frame) * 0.5F);
    strip(110, 100);
    glUseProgram(varied);
    strip(10, 140);
    glUseProgram(0);
}

void makeTexture() {
    GLubyte texels[4 * 4 * 4];
    Sequence numbers(21);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {},
        [](Window&) {
            makePrograms();
            makeTexture();
        },
        [](Window&, int frame) {
            glClearColor(0.12F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            glMatrixMode(GL_MODELVIEW);
            drawOld(frame);
            drawMixed(frame);
            drawNewer(frame);
        });
}
