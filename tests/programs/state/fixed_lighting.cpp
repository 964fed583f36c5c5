// The fixed-function pipeline: lights of all kinds, materials, colour material, two sides, fog, texture environments
// and combiners, texture coordinate generation, matrix stacks, normal rescaling.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cmath>

using namespace programs;

namespace {

GLuint textures[3];

// Draws a bumpy patch of 8×8 quads around the origin.
void patch(int frame, bool colored = false) {
    const auto height = [&](int x, int y) {
        return std::sin(float(x) * 0.9F + float(frame)) * std::cos(float(y) * 0.7F) * 0.3F;
    };
    for (int y = -4; y < 4; ++y) {
        glBegin(GL_QUAD_STRIP);
        for (int x = -4; x <= 4; ++x) {
            for (int side = 1; side >= 0; --side) {
                const float dx = height(x + 1, y + side) - height(x - 1, y + side);
                const float dy = height(x, y + side + 1) - height(x, y + side - 1);
                if (colored) {
                    glColor3f(float(x + 4) / 8, float(y + 4) / 8, 0.5F);
                }
                glNormal3f(-dx * 2, -dy * 2, 1);
                glTexCoord2f(float(x) * 0.3F, float(y + side) * 0.3F);
                glVertex3f(float(x) * 0.25F, float(y + side) * 0.25F, height(x, y + side));
            }
        }
        glEnd();
    }
}

void enterCell(int cell, int frame) {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    const double x = cell % 4;
    const double y = cell / 4;
    // The whole window's frustum, shifted so that the patch at the origin appears in its cell.
    glFrustum(-0.25 - x * 0.5, 1.75 - x * 0.5, -0.25 - y * 0.5, 1.75 - y * 0.5, 1, 20);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glTranslatef(0, 0, -5);
    glRotatef(-40 + float(frame) * 7, 1, 0, 0);
    glRotatef(25 + float(cell) * 10, 0, 0, 1);
}

void drawLights(int frame) {
    const GLfloat red[] = {0.9F, 0.2F, 0.1F, 1};
    const GLfloat blue[] = {0.1F, 0.3F, 0.9F, 1};
    const GLfloat white[] = {1, 1, 1, 1};
    const GLfloat direction[] = {0.5F, 0.7F, 1, 0};
    const GLfloat place[] = {0.8F, 0.3F, 0.9F, 1};
    const GLfloat aim[] = {-0.5F, -0.2F, -1};
    const GLint ambient[] = {1 << 29, 1 << 28, 1 << 28, 1 << 30};
    glEnable(GL_LIGHTING);
    glEnable(GL_NORMALIZE);
    enterCell(0, frame);
    glLightfv(GL_LIGHT0, GL_POSITION, direction);
    glLightfv(GL_LIGHT0, GL_DIFFUSE, red);
    glLightiv(GL_LIGHT0, GL_AMBIENT, ambient);
    glEnable(GL_LIGHT0);
    patch(frame);
    enterCell(1, frame);
    glLightfv(GL_LIGHT1, GL_POSITION, place);
    glLightfv(GL_LIGHT1, GL_DIFFUSE, blue);
    glLightfv(GL_LIGHT1, GL_SPECULAR, white);
    glLightf(GL_LIGHT1, GL_LINEAR_ATTENUATION, 0.4F);
    glLightf(GL_LIGHT1, GL_QUADRATIC_ATTENUATION, 0.1F);
    glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, white);
    glMateriali(GL_FRONT_AND_BACK, GL_SHININESS, 30);
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, GL_TRUE);
    glEnable(GL_LIGHT1);
    patch(frame);
    enterCell(2, frame);
    glLightfv(GL_LIGHT2, GL_POSITION, place);
    glLightfv(GL_LIGHT2, GL_SPOT_DIRECTION, aim);
    glLightf(GL_LIGHT2, GL_SPOT_CUTOFF, 35);
    glLighti(GL_LIGHT2, GL_SPOT_EXPONENT, 6);
    glLightfv(GL_LIGHT2, GL_DIFFUSE, white);
    glDisable(GL_LIGHT1);
    glEnable(GL_LIGHT2);
    glLightModeli(GL_LIGHT_MODEL_COLOR_CONTROL, GL_SEPARATE_SPECULAR_COLOR);
    patch(frame);
    // Both sides, seen from below, with the material following the colour.
    enterCell(3, frame);
    glRotatef(150, 1, 0, 0);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, GL_TRUE);
    glColorMaterial(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE);
    glEnable(GL_COLOR_MATERIAL);
    patch(frame, true);
    glDisable(GL_COLOR_MATERIAL);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, GL_FALSE);
    glLightModeli(GL_LIGHT_MODEL_COLOR_CONTROL, GL_SINGLE_COLOR);
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, GL_FALSE);
    GLfloat readBack[4];
    glGetLightfv(GL_LIGHT2, GL_POSITION, readBack);
    glDisable(GL_LIGHT2);
    glDisable(GL_LIGHT0);
    glDisable(GL_LIGHTING);
    showBits(37, readBack[0]);
}

void drawFog(int frame) {
    const GLfloat color[] = {0.5F, 0.6F, 0.2F, 1};
    glFogfv(GL_FOG_COLOR, color);
    glFogi(GL_FOG_COORD_SRC, GL_FRAGMENT_DEPTH);
    glFogf(GL_FOG_DENSITY, 0.15F + 0.02F * float(frame));
    glFogf(GL_FOG_START, 4);
    glFogf(GL_FOG_END, 6.5F);
    glEnable(GL_FOG);
    int cell = 4;
    for (const GLenum mode : {GL_LINEAR, GL_EXP, GL_EXP2}) {
        glFogi(GL_FOG_MODE, GLint(mode));
        enterCell(cell++, frame);
        patch(frame, true);
    }
    glDisable(GL_FOG);
}

void drawEnvironments(int frame) {
    const GLfloat constant[] = {0.4F, 0.1F * float(frame), 0.8F, 1};
    glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, constant);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glEnable(GL_TEXTURE_2D);
    int cell = 7;
    for (const GLenum mode : {GL_BLEND, GL_ADD}) {
        glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GLint(mode));
        enterCell(cell++, frame);
        patch(frame, true);
    }
    // Two units: interpolate, then dot product.
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_COMBINE);
    glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB, GL_INTERPOLATE);
    glTexEnvi(GL_TEXTURE_ENV, GL_SRC0_RGB, GL_TEXTURE);
    glTexEnvi(GL_TEXTURE_ENV, GL_SRC1_RGB, GL_PRIMARY_COLOR);
    glTexEnvi(GL_TEXTURE_ENV, GL_SRC2_RGB, GL_CONSTANT);
    glTexEnvi(GL_TEXTURE_ENV, GL_OPERAND2_RGB, GL_SRC_COLOR);
    glTexEnvf(GL_TEXTURE_ENV, GL_RGB_SCALE, 2);
    enterCell(cell++, frame);
    patch(frame, true);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, textures[1]);
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_COMBINE);
    glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB, GL_DOT3_RGB);
    glTexEnvi(GL_TEXTURE_ENV, GL_SRC0_RGB, GL_PREVIOUS);
    glTexEnvi(GL_TEXTURE_ENV, GL_SRC1_RGB, GL_TEXTURE);
    glTexGeni(GL_S, GL_TEXTURE_GEN_MODE, GL_OBJECT_LINEAR);
    glTexGeni(GL_T, GL_TEXTURE_GEN_MODE, GL_OBJECT_LINEAR);
    const GLfloat plane[] = {0.3F, 1, 0, 0.5F};
    const GLdouble other[] = {1, 0, 0.3, 0};
    glTexGenfv(GL_S, GL_OBJECT_PLANE, plane);
    glTexGendv(GL_T, GL_OBJECT_PLANE, other);
    glEnable(GL_TEXTURE_GEN_S);
    glEnable(GL_TEXTURE_GEN_T);
    enterCell(cell++, frame);
    patch(frame, true);
    glDisable(GL_TEXTURE_GEN_S);
    glDisable(GL_TEXTURE_GEN_T);
    glDisable(GL_TEXTURE_2D);
    glActiveTexture(GL_TEXTURE0);
    glTexEnvf(GL_TEXTURE_ENV, GL_RGB_SCALE, 1);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
}

void drawGenerated(int frame) {
    glColor3f(1, 1, 1);
    int cell = 11;
    for (const GLint mode : {GL_EYE_LINEAR, GL_SPHERE_MAP, GL_REFLECTION_MAP, GL_NORMAL_MAP}) {
        const bool cube = mode == GL_REFLECTION_MAP || mode == GL_NORMAL_MAP;
        const GLenum target = cube ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D;
        glDisable(GL_TEXTURE_2D);
        glBindTexture(target, textures[cube ? 2 : 1]);
        glEnable(target);
        enterCell(cell++, frame);
        const GLfloat eyePlane[] = {0.6F, 0.2F, 0.1F, 0.2F};
        for (const GLenum coordinate : {GL_S, GL_T, GL_R}) {
            if (coordinate == GL_R && !cube) {
                continue;
            }
            glTexGeni(coordinate, GL_TEXTURE_GEN_MODE, mode);
            if (mode == GL_EYE_LINEAR) {
                glTexGenfv(coordinate, GL_EYE_PLANE, eyePlane);
            }
            glEnable(coordinate - GL_S + GL_TEXTURE_GEN_S);
        }
        // The texture matrix has its own stack.
        glMatrixMode(GL_TEXTURE);
        glPushMatrix();
        glRotatef(float(frame) * 11, 0, 0, 1);
        glMatrixMode(GL_MODELVIEW);
        patch(frame);
        glMatrixMode(GL_TEXTURE);
        glPopMatrix();
        glMatrixMode(GL_MODELVIEW);
        for (const GLenum generator : {GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T, GL_TEXTURE_GEN_R}) {
            glDisable(generator);
        }
        glDisable(target);
    }
}

void drawMatrices(int frame) {
    enterCell(15, frame);
    const GLfloat shear[16] = {1, 0.2F, 0, 0, 0.3F, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const GLdouble scale[16] = {0.6, 0, 0, 0, 0, 0, 0.1, 0, 0, 0.7, 0, 0, 0, 0, 0, 1};
    glPushMatrix();
    glMultMatrixf(shear);
    glMultTransposeMatrixd(scale);
    glRotated(90, 1, 0, 0);
    glEnable(GL_RESCALE_NORMAL);
    patch(frame, true);
    glDisable(GL_RESCALE_NORMAL);
    glPopMatrix();
    glScaled(0.3, 0.3, 0.3);
    glTranslated(1.5, 0, 0.2);
    patch(frame, true);
    GLfloat readBack[16];
    glGetFloatv(GL_MODELVIEW_MATRIX, readBack);
    showBits(36, readBack[12]);
}

void setUp() {
    glGenTextures(3, textures);
    GLubyte texels[8 * 8 * 4];
    for (unsigned i = 0; i < 8; ++i) {
        Sequence numbers(i);
        for (GLubyte& value : texels) {
            value = numbers.byte();
        }
        const GLenum target = i < 2 ? GL_TEXTURE_2D : GL_TEXTURE_CUBE_MAP;
        glBindTexture(target, textures[i < 2 ? i : 2]);
        glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexImage2D(i < 2 ? target : GL_TEXTURE_CUBE_MAP_POSITIVE_X + i - 2, 0, GL_RGBA8, 8, 8, 0, GL_RGBA,
                     GL_UNSIGNED_BYTE, texels);
    }
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.1F, 0.12F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glEnable(GL_DEPTH_TEST);
            drawLights(frame);
            drawFog(frame);
            drawEnvironments(frame);
            drawGenerated(frame);
            drawMatrices(frame);
            glDisable(GL_DEPTH_TEST);
        });
}
