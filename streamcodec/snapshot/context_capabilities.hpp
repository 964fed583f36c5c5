// Capabilities of glEnable that belong to the context, independent of the active texture unit.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
#include <cstdint>

namespace mural::snapshot {

// Returns true for capabilities of the context. Others count as per texture unit, which is safe but keeps more
// commands.
inline bool isContextCap(uint32_t what) {
    switch (what) {
    case GL_BLEND:
    case GL_DEPTH_TEST:
    case GL_CULL_FACE:
    case GL_SCISSOR_TEST:
    case GL_STENCIL_TEST:
    case GL_ALPHA_TEST:
    case GL_LIGHTING:
    case GL_FOG:
    case GL_NORMALIZE:
    case GL_RESCALE_NORMAL:
    case GL_COLOR_MATERIAL:
    case GL_COLOR_LOGIC_OP:
    case GL_DITHER:
    case GL_LINE_SMOOTH:
    case GL_LINE_STIPPLE:
    case GL_POINT_SMOOTH:
    case GL_POINT_SPRITE:
    case GL_POLYGON_SMOOTH:
    case GL_POLYGON_STIPPLE:
    case GL_POLYGON_OFFSET_FILL:
    case GL_POLYGON_OFFSET_LINE:
    case GL_POLYGON_OFFSET_POINT:
    case GL_MULTISAMPLE:
    case GL_RASTERIZER_DISCARD:
    case GL_PROGRAM_POINT_SIZE:
    case GL_PRIMITIVE_RESTART:
    case GL_PRIMITIVE_RESTART_FIXED_INDEX:
    case GL_TEXTURE_CUBE_MAP_SEAMLESS:
    case GL_FRAMEBUFFER_SRGB: return true;
    default: return (what >= GL_LIGHT0 && what <= GL_LIGHT7) || (what >= GL_CLIP_PLANE0 && what <= GL_CLIP_PLANE0 + 7);
    }
}

} // namespace mural::snapshot
