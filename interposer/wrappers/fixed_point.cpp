// Fixed-point commands of OES_fixed_point that are sent as their floating-point counterparts.
#include "custom_wrappers.hpp"

extern "C" void mural_glAccum(GLenum op, GLfloat value); // generated

namespace {
GLfloat fromFixed(GLfixed value) { return static_cast<GLfloat>(value) / 65536; }
} // namespace

extern "C" {

void mural_glBitmapxOES(GLsizei width, GLsizei height, GLfixed xorig, GLfixed yorig, GLfixed xmove, GLfixed ymove,
                        const GLubyte* bitmap) {
    mural_glBitmap(width, height, fromFixed(xorig), fromFixed(yorig), fromFixed(xmove), fromFixed(ymove), bitmap);
}

void mural_glAccumxOES(GLenum op, GLfixed value) { mural_glAccum(op, fromFixed(value)); }

} // extern "C"
