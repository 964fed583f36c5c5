// The GL functions of the test scenes, resolved as each backend resolves them.
#pragma once

#include <functional>

#define GL_GLEXT_PROTOTYPES // for the types only: libGL is not linked
#include <GL/gl.h>
#include <GL/glext.h>

namespace mural::test {

using FindProc = std::function<void (*(const char*))()>;

// Without fixed-point entry points and the rest of ES 1: its float commands are the desktop's.
struct GlFunctions {
    explicit GlFunctions(const FindProc& find);

    decltype(&glAttachShader) attachShader;
    decltype(&glBegin) begin;
    decltype(&glBindBuffer) bindBuffer;
    decltype(&glBindFramebuffer) bindFramebuffer;
    decltype(&glBindTexture) bindTexture;
    decltype(&glBindVertexArray) bindVertexArray;
    decltype(&glBitmap) bitmap;
    decltype(&glBlendFunc) blendFunc;
    decltype(&glBufferData) bufferData;
    decltype(&glClear) clear;
    decltype(&glClearColor) clearColor;
    decltype(&glClearStencil) clearStencil;
    decltype(&glColor4f) color4f;
    decltype(&glColorPointer) colorPointer;
    decltype(&glCompileShader) compileShader;
    decltype(&glCreateProgram) createProgram;
    decltype(&glCreateShader) createShader;
    decltype(&glDisable) disable;
    decltype(&glDrawArrays) drawArrays;
    decltype(&glDrawBuffer) drawBuffer;
    decltype(&glDrawPixels) drawPixels;
    decltype(&glEnable) enable;
    decltype(&glEnableClientState) enableClientState;
    decltype(&glEnableVertexAttribArray) enableVertexAttribArray;
    decltype(&glEnd) end;
    decltype(&glFinish) finish;
    decltype(&glFrustum) frustum;
    decltype(&glGenBuffers) genBuffers;
    decltype(&glGenTextures) genTextures;
    decltype(&glGenVertexArrays) genVertexArrays;
    decltype(&glGenerateMipmap) generateMipmap;
    decltype(&glGetError) getError;
    decltype(&glGetIntegerv) getIntegerv;
    decltype(&glGetProgramiv) getProgramiv;
    decltype(&glGetShaderInfoLog) getShaderInfoLog;
    decltype(&glGetString) getString;
    decltype(&glGetTexImage) getTexImage;
    decltype(&glLineStipple) lineStipple;
    decltype(&glLineWidth) lineWidth;
    decltype(&glLinkProgram) linkProgram;
    decltype(&glLoadIdentity) loadIdentity;
    decltype(&glMatrixMode) matrixMode;
    decltype(&glPixelStorei) pixelStorei;
    decltype(&glPixelTransferf) pixelTransferf;
    decltype(&glPointSize) pointSize;
    decltype(&glPolygonStipple) polygonStipple;
    decltype(&glRasterPos2f) rasterPos2f;
    decltype(&glReadBuffer) readBuffer;
    decltype(&glReadPixels) readPixels;
    decltype(&glScissor) scissor;
    decltype(&glShaderSource) shaderSource;
    decltype(&glStencilFunc) stencilFunc;
    decltype(&glStencilOp) stencilOp;
    decltype(&glTexCoord2f) texCoord2f;
    decltype(&glTexCoordPointer) texCoordPointer;
    decltype(&glTexImage2D) texImage2D;
    decltype(&glTexParameteri) texParameteri;
    decltype(&glUseProgram) useProgram;
    decltype(&glVertex3f) vertex3f;
    decltype(&glVertexAttribPointer) vertexAttribPointer;
    decltype(&glVertexPointer) vertexPointer;
    decltype(&glViewport) viewport;
    decltype(&glAccum) accum;
    decltype(&glBindAttribLocation) bindAttribLocation;
    decltype(&glIsEnabled) isEnabled;
    decltype(&glGetFloatv) getFloatv;
    decltype(&glIsTexture) isTexture;
    decltype(&glColorMask) colorMask;
    decltype(&glGenRenderbuffers) genRenderbuffers;
    decltype(&glBindRenderbuffer) bindRenderbuffer;
    decltype(&glRenderbufferStorage) renderbufferStorage;
    decltype(&glGenFramebuffers) genFramebuffers;
    decltype(&glFramebufferRenderbuffer) framebufferRenderbuffer;
    decltype(&glBlitFramebuffer) blitFramebuffer;
    decltype(&glDeleteFramebuffers) deleteFramebuffers;
    decltype(&glDeleteRenderbuffers) deleteRenderbuffers;
    decltype(&glDrawBuffers) drawBuffers;
};

} // namespace mural::test
