// The number of values at an input pointer whose length the registry (gl.xml) specifies as COMPSIZE(…). Covered:
//   pname       the …Count functions below
//   buffer      clearBufferCount
//   count       the k…Values constants, per element
//   name, (label|message|buf, length)  stringBytes
//   id of EXT_vertex_shader            variantCount, by the data type of the symbol
//   () of glReplacementCodeu*SUN       1 value
//   attrib_list                        attribListCount
//   (n,type)                           callListsBytes
//   (target,stride,order) …            evaluator_maps.hpp
//   drawcount, indices, vertex types   vertex_types.hpp, index_range.hpp
//   images and glPolygonStipple        pixel_format.hpp, compressed_block.hpp
//   size, numBufferBarriers, numTextureBarriers, uniformCount: other parameters, unchanged
//
// Not covered, because no current driver has them or they never affect drawing: NV_path_rendering (gl*Path*NV),
// glMapControlPointsNV and glMapParameter*NV, glMapVertexAttrib*APPLE, glDeformationMap3*SGIX, glIglooInterfaceSGIX,
// glVideoCaptureStreamParameter*NV, glShadingRateSampleOrderCustomNV, the vertex arrays (see client_arrays), and
// callbacks (glDebugMessageCallback: the pointer belongs to the program).
#pragma once

#include <cstddef>
#include <cstdint>

#include <GL/gl.h>

#include "streamcodec/sizes/compressed_block.hpp"
#include "streamcodec/sizes/evaluator_maps.hpp"
#include "streamcodec/sizes/index_range.hpp"
#include "streamcodec/sizes/vertex_types.hpp"

namespace mural::sizes {

// Values of gl<Name>*v for a pname. An unknown pname counts as one value: extensions nearly always add single numbers,
// and drivers read one value before they reject a pname (measured with Mesa). Callers check for null pointers.
uint32_t texParameterCount(GLenum pname); // also glTextureParameter*, glMultiTexParameter*
uint32_t texEnvCount(GLenum pname);       // also glMultiTexEnv*
uint32_t texGenCount(GLenum pname);       // also glMultiTexGen*
uint32_t lightCount(GLenum pname);        // also glFragmentLight*SGIX
uint32_t lightModelCount(GLenum pname);   // also glFragmentLightModel*SGIX
uint32_t materialCount(GLenum pname);     // also glFragmentMaterial*SGIX
uint32_t fogCount(GLenum pname);
uint32_t pointParameterCount(GLenum pname);
uint32_t samplerParameterCount(GLenum pname);
uint32_t patchParameterCount(GLenum pname);
uint32_t convolutionParameterCount(GLenum pname);
uint32_t colorTableParameterCount(GLenum pname);
uint32_t combinerParameterCount(GLenum pname); // glCombinerParameter*NV, glCombinerStageParameter*NV
uint32_t spriteParameterCount(GLenum pname);   // SGIX
uint32_t texBumpParameterCount(GLenum pname);  // ATI
uint32_t singleParameterCount(GLenum pname);   // glListParameter*SGIX, glImageTransformParameter*HP,
                                               // glPixelTexGenParameter*SGIS: one value each

// glClear(Named)Buffer*v; 0: not a buffer.
uint32_t clearBufferCount(GLenum buffer);

// glVariant*vEXT, glSetInvariantEXT, glSetLocalConstantEXT: dataType as in glGenSymbolsEXT; 0: none.
uint32_t variantCount(GLenum dataType);

// Values per element of `count` elements.
constexpr uint32_t kDepthRangeValues = 2;              // glDepthRangeArray*v
constexpr uint32_t kScissorValues = 4;                 // glScissorArrayv*, glScissorExclusiveArrayvNV
constexpr uint32_t kViewportValues = 4;                // glViewportArrayv*
constexpr uint32_t kWindowRectangleValues = 4;         // glWindowRectanglesEXT
constexpr uint32_t kSampleLocationValues = 2;          // gl*FramebufferSampleLocationsfv*
constexpr uint32_t kTransformFeedbackAttribValues = 3; // glTransformFeedbackAttribsNV

// Bytes of a text that GL reads: `length`, or if negative, all including the final zero. 0 for a null pointer.
size_t stringBytes(const char* text, GLsizei length);

// Values of a list up to and including GL_NONE (glTexStorageAttribs*EXT, glEGLImageTargetTexStorageEXT). 0 for a null
// pointer.
size_t attribListCount(const GLint* list);

// glCallLists; 0: n < 0, or not a type.
size_t callListsBytes(GLsizei n, GLenum type);

} // namespace mural::sizes
