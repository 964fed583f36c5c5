// The constants of OpenGL, its extensions and OpenGL ES. No functions: sizes never call GL.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>

#include <GLES2/gl2platform.h>
// gl2ext.h needs the macros of gl2platform.h
#include <GLES2/gl2ext.h>

// Names that only the OpenGL ES 1 header defines. It cannot be included together with GL/gl.h.
#ifndef GL_TEXTURE_CROP_RECT_OES
#define GL_TEXTURE_CROP_RECT_OES 0x8B9D
#endif
// ATI_texture_compression_3dc is not in the registry, but drivers accept the value.
#ifndef GL_COMPRESSED_LUMINANCE_ALPHA_3DC_ATI
#define GL_COMPRESSED_LUMINANCE_ALPHA_3DC_ATI 0x8837
#endif
