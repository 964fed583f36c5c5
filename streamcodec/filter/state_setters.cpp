#include "streamcodec/filter/state_setters.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "gl_opcodes.hpp"
#include "streamcodec/snapshot/command_effects.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::filter {
namespace {

using trace::argumentWord;
using trace::Family;
using trace::RecordView;

enum Cell : uint8_t {
    kDepthMask,
    kDepthFunc,
    kDepthRange,
    kClearDepth,
    kStencilMask,
    kStencilFunc,
    kStencilOp,
    kClearStencil,
    kColorMask,
    kClearColor,
    kAlphaFunc,
    kBlendFunc,
    kBlendEquation,
    kBlendColor,
    kLogicOp,
    kViewport,
    kScissor,
    kCullFace,
    kFrontFace,
    kPolygonMode,
    kPolygonOffset,
    kShadeModel,
    kProvokingVertex,
    kPrimitiveRestartIndex,
    kLineWidth,
    kLineStipple,
    kPointSize,
    kPixelZoom,
    kSampleCoverage,
    kMinSampleShading,
    kMatrixMode,
    kFirstCap = 64,
};
constexpr uint32_t kFirstUnitCap = 128, kCapsOfUnit = 16;
constexpr uint32_t kUnitsWithCaps = 8; // fixed-function texture units, as many as drivers have

// ---- checks that every GL accepts a value

using Check = bool (*)(const RecordView& r);

bool any(const RecordView&) { return true; }
bool never(const RecordView&) { return false; } // sets a part of the cell, or one of several buffers, viewports, faces
bool within(uint32_t value, uint32_t first, uint32_t last) { return value >= first && value <= last; }
bool compares(const RecordView& r) { return within(argumentWord(r, 0), GL_NEVER, GL_ALWAYS); }
bool blends(const RecordView& r) {
    const size_t words = r.opcode == op::glBlendFunc ? 2 : 4;
    for (size_t i = 0; i < words; ++i) {
        const uint32_t factor = argumentWord(r, i);
        const bool ofSource =
            i % 2 == 0 && factor == GL_SRC_ALPHA_SATURATE; // not valid as a destination factor in every GL
        if (factor > GL_ONE && !within(factor, GL_SRC_COLOR, GL_ONE_MINUS_DST_COLOR) &&
            !within(factor, GL_CONSTANT_COLOR, GL_ONE_MINUS_CONSTANT_ALPHA) && !ofSource)
            return false;
    }
    return true;
}
bool isEquation(uint32_t e) { return e == GL_FUNC_ADD || e == GL_FUNC_SUBTRACT || e == GL_FUNC_REVERSE_SUBTRACT; }
bool equation(const RecordView& r) { return isEquation(argumentWord(r, 0)); }
bool equations(const RecordView& r) { return isEquation(argumentWord(r, 0)) && isEquation(argumentWord(r, 1)); }
bool stencilOps(const RecordView& r) {
    constexpr std::array<uint32_t, 8> kAll{GL_ZERO, GL_KEEP,   GL_REPLACE,   GL_INCR,
                                           GL_DECR, GL_INVERT, GL_INCR_WRAP, GL_DECR_WRAP};
    return std::ranges::count(kAll, argumentWord(r, 0)) && std::ranges::count(kAll, argumentWord(r, 1)) &&
           std::ranges::count(kAll, argumentWord(r, 2));
}
bool logicOp(const RecordView& r) { return within(argumentWord(r, 0), GL_CLEAR, GL_SET); }
bool rectangle(const RecordView& r) {
    return static_cast<int32_t>(argumentWord(r, 2)) >= 0 && static_cast<int32_t>(argumentWord(r, 3)) >= 0;
}
bool face(const RecordView& r) {
    return within(argumentWord(r, 0), GL_FRONT, GL_BACK) || argumentWord(r, 0) == GL_FRONT_AND_BACK;
}
bool winding(const RecordView& r) { return within(argumentWord(r, 0), GL_CW, GL_CCW); }
bool bothFaces(const RecordView& r) {
    return argumentWord(r, 0) == GL_FRONT_AND_BACK && within(argumentWord(r, 1), GL_POINT, GL_FILL);
}
bool shading(const RecordView& r) { return within(argumentWord(r, 0), GL_FLAT, GL_SMOOTH); }
bool convention(const RecordView& r) {
    return within(argumentWord(r, 0), GL_FIRST_VERTEX_CONVENTION, GL_LAST_VERTEX_CONVENTION);
}
bool thinLine(const RecordView& r) { // forward-compatible contexts refuse wider lines
    const auto width = std::bit_cast<float>(argumentWord(r, 0));
    return width > 0 && width <= 1;
}
bool positive(const RecordView& r) { return std::bit_cast<float>(argumentWord(r, 0)) > 0; }
bool matrixMode(const RecordView& r) { return within(argumentWord(r, 0), GL_MODELVIEW, GL_TEXTURE); }

struct StateCommand {
    uint16_t opcode;
    Cell cell;
    Check check;
};
constexpr StateCommand kCommands[] = {
    {op::glDepthMask, kDepthMask, any},
    {op::glDepthFunc, kDepthFunc, compares},
    {op::glClearDepth, kClearDepth, any},
    {op::glClearDepthf, kClearDepth, any},
    {op::glDepthRange, kDepthRange, any},
    {op::glDepthRangef, kDepthRange, any},
    {op::glDepthRangeArrayv, kDepthRange, never},
    {op::glDepthRangeIndexed, kDepthRange, never},
    {op::glStencilMask, kStencilMask, any},
    {op::glStencilMaskSeparate, kStencilMask, never},
    {op::glStencilFunc, kStencilFunc, compares},
    {op::glStencilFuncSeparate, kStencilFunc, never},
    {op::glStencilOp, kStencilOp, stencilOps},
    {op::glStencilOpSeparate, kStencilOp, never},
    {op::glClearStencil, kClearStencil, any},
    {op::glColorMask, kColorMask, any},
    {op::glColorMaski, kColorMask, never},
    {op::glClearColor, kClearColor, any},
    {op::glAlphaFunc, kAlphaFunc, compares},
    {op::glBlendFunc, kBlendFunc, blends},
    {op::glBlendFuncSeparate, kBlendFunc, blends},
    {op::glBlendFunci, kBlendFunc, never},
    {op::glBlendFuncSeparatei, kBlendFunc, never},
    {op::glBlendEquation, kBlendEquation, equation},
    {op::glBlendEquationSeparate, kBlendEquation, equations},
    {op::glBlendEquationi, kBlendEquation, never},
    {op::glBlendEquationSeparatei, kBlendEquation, never},
    {op::glBlendColor, kBlendColor, any},
    {op::glLogicOp, kLogicOp, logicOp},
    {op::glViewport, kViewport, rectangle},
    {op::glViewportArrayv, kViewport, never},
    {op::glViewportIndexedf, kViewport, never},
    {op::glViewportIndexedfv, kViewport, never},
    {op::glScissor, kScissor, rectangle},
    {op::glScissorArrayv, kScissor, never},
    {op::glScissorIndexed, kScissor, never},
    {op::glScissorIndexedv, kScissor, never},
    {op::glCullFace, kCullFace, face},
    {op::glFrontFace, kFrontFace, winding},
    {op::glPolygonMode, kPolygonMode, bothFaces},
    {op::glPolygonOffset, kPolygonOffset, any},
    {op::glPolygonOffsetClamp, kPolygonOffset, never},
    {op::glShadeModel, kShadeModel, shading},
    {op::glProvokingVertex, kProvokingVertex, convention},
    {op::glPrimitiveRestartIndex, kPrimitiveRestartIndex, any},
    {op::glLineWidth, kLineWidth, thinLine},
    {op::glLineStipple, kLineStipple, any},
    {op::glPointSize, kPointSize, positive},
    {op::glPixelZoom, kPixelZoom, any},
    {op::glSampleCoverage, kSampleCoverage, any},
    {op::glMinSampleShading, kMinSampleShading, any},
    {op::glMatrixMode, kMatrixMode, matrixMode},
};

const StateCommand* commandOf(uint16_t opcode) {
    const auto* const found = std::ranges::find(kCommands, opcode, &StateCommand::opcode);
    return found == std::end(kCommands) ? nullptr : found;
}

// ---- capabilities

// Returns the cell of a capability of the context. kNoCell: not tracked, because it has other effects than on later
// draws. Example: enabling GL_COLOR_MATERIAL takes the current colour at that moment.
uint32_t contextCap(uint32_t what) {
    if (what >= GL_LIGHT0 && what <= GL_LIGHT7) return kFirstCap + 40 + (what - GL_LIGHT0);
    if (what >= GL_CLIP_PLANE0 && what < GL_CLIP_PLANE0 + 8) return kFirstCap + 48 + (what - GL_CLIP_PLANE0);
    constexpr std::array<uint32_t, 33> kAll{GL_BLEND,
                                            GL_DEPTH_TEST,
                                            GL_CULL_FACE,
                                            GL_SCISSOR_TEST,
                                            GL_STENCIL_TEST,
                                            GL_ALPHA_TEST,
                                            GL_LIGHTING,
                                            GL_FOG,
                                            GL_NORMALIZE,
                                            GL_RESCALE_NORMAL,
                                            GL_COLOR_LOGIC_OP,
                                            GL_DITHER,
                                            GL_LINE_SMOOTH,
                                            GL_LINE_STIPPLE,
                                            GL_POINT_SMOOTH,
                                            GL_POINT_SPRITE,
                                            GL_POLYGON_SMOOTH,
                                            GL_POLYGON_STIPPLE,
                                            GL_POLYGON_OFFSET_FILL,
                                            GL_POLYGON_OFFSET_LINE,
                                            GL_POLYGON_OFFSET_POINT,
                                            GL_MULTISAMPLE,
                                            GL_RASTERIZER_DISCARD,
                                            GL_PROGRAM_POINT_SIZE,
                                            GL_PRIMITIVE_RESTART,
                                            GL_PRIMITIVE_RESTART_FIXED_INDEX,
                                            GL_TEXTURE_CUBE_MAP_SEAMLESS,
                                            GL_FRAMEBUFFER_SRGB,
                                            GL_DEPTH_CLAMP,
                                            GL_SAMPLE_ALPHA_TO_COVERAGE,
                                            GL_SAMPLE_ALPHA_TO_ONE,
                                            GL_SAMPLE_COVERAGE,
                                            GL_COLOR_SUM};
    static_assert(kAll.size() <= 40);
    const auto* const found = std::ranges::find(kAll, what);
    return found == kAll.end() ? kNoCell : kFirstCap + static_cast<uint32_t>(found - kAll.begin());
}

uint32_t unitCap(uint32_t what, uint32_t unit) {
    if (unit >= kUnitsWithCaps) return kNoCell;
    constexpr std::array<uint32_t, 9> kAll{GL_TEXTURE_1D,       GL_TEXTURE_2D,        GL_TEXTURE_3D,
                                           GL_TEXTURE_CUBE_MAP, GL_TEXTURE_RECTANGLE, GL_TEXTURE_GEN_S,
                                           GL_TEXTURE_GEN_T,    GL_TEXTURE_GEN_R,     GL_TEXTURE_GEN_Q};
    const auto* const found = std::ranges::find(kAll, what);
    return found == kAll.end() ? kNoCell
                               : kFirstUnitCap + unit * kCapsOfUnit + static_cast<uint32_t>(found - kAll.begin());
}

bool isCap(uint16_t opcode) { return opcode == op::glEnable || opcode == op::glDisable; }
bool isIndexedCap(uint16_t opcode) { return opcode == op::glEnablei || opcode == op::glDisablei; }

// ---- roles

StateRole ofFamily(uint16_t opcode) {
    switch (trace::ruleOf(opcode).family) {
    case Family::Cell: return hasTrait(opcode, Trait::StandsAlone) ? StateRole::None : StateRole::Change;
    case Family::Nothing:
    case Family::CellOfMatrix:
    case Family::UnitCell:
    case Family::UnitCellOfMatrix:
    case Family::ClientCap:
    case Family::ClientCell:
    case Family::Attribute:
    case Family::Color:
    case Family::PatternedCell:
    case Family::ActiveTexture:
    case Family::ClientActiveTexture:
    case Family::ListBase:
    case Family::MatrixLoad:
    case Family::MatrixChange:
    case Family::MatrixPush:
    case Family::MatrixPop:
    case Family::ClientPush:
    case Family::ClientPop:
    case Family::Gen:
    case Family::Create:
    case Family::GenLists:
    case Family::Delete:
    case Family::DeleteList:
    case Family::Bind:
    case Family::BindIndexed:
    case Family::UseProgram:
    case Family::ArrayPointer:
    case Family::ArraySet:
    case Family::ArrayNamedSet:
    case Family::BufferData:
    case Family::BufferSubData:
    case Family::TexParameter:
    case Family::TexImage:
    case Family::TexStorage:
    case Family::TexSubImage:
    case Family::TexMipmaps:
    case Family::TexBuffer:
    case Family::RenderbufferStorage:
    case Family::NamedSet:
    case Family::FramebufferAttach:
    case Family::FramebufferSet:
    case Family::FramebufferNamed:
    case Family::DrawBuffers:
    case Family::ShaderSet:
    case Family::ShaderCompile:
    case Family::ProgramAttach:
    case Family::ProgramDetach:
    case Family::ProgramSet:
    case Family::ProgramLink:
    case Family::ProgramDelete:
    case Family::ShaderDelete:
    case Family::Uniform:
    case Family::ProgramUniform:
    case Family::PipelineSet:
    case Family::ArbProgram:
    case Family::SyncMake:
    case Family::SyncDelete:
    case Family::Barrier:
    case Family::Vertex:
    case Family::End:
    case Family::EndList:
    case Family::QueryBegin:
    case Family::QueryEnd:
    case Family::QueryCounter: return StateRole::None;
    case Family::CellOfAll:
    case Family::Draw:
    case Family::Compute:
    case Family::ReadsPicture:
    case Family::Clear:
    case Family::ClearBuffer:
    case Family::Blit:
    case Family::TexCopyImage:
    case Family::TexCopySubImage:
    case Family::Begin:
    case Family::NewList:
    case Family::AttribPush:
    case Family::FeedbackBegin:
    case Family::FeedbackEnd:
    case Family::ConditionalEnd: return StateRole::Use;
    default: return StateRole::Change; // glPopAttrib, lists, limits of single buffers, commands without an effect
    }
}

StateRole ofOwn(uint16_t opcode) {
    switch (opcode) {
    case wire::kOpBlobBegin:
    case wire::kOpBlobData:
    case wire::kOpBufferBytes:
    case wire::kOpSwap: // only earlier draws matter
    case wire::kOpFrontPicture:
    case wire::kOpProgramLayout:
    case wire::kOpProgramRecipe:
    case wire::kOpErrorReported: return StateRole::None;
    default: return StateRole::Use; // requests, other contexts and windows
    }
}

// Indices into kCommands by opcode; kNone: a capability.
constexpr uint8_t kNone = 0xff;
std::vector<uint8_t> allPlaces() {
    std::vector<uint8_t> places(op::kLimit, kNone);
    for (size_t i = 0; i < std::size(kCommands); ++i) places[kCommands[i].opcode] = static_cast<uint8_t>(i);
    return places;
}

} // namespace

StateRole stateRoleOf(uint16_t opcode) {
    if (opcode < wire::kFirstGlOpcode) return ofOwn(opcode);
    return commandOf(opcode) != nullptr || isCap(opcode) || isIndexedCap(opcode) ? StateRole::Set : ofFamily(opcode);
}

StateSet stateSetOf(const RecordView& r, uint32_t unit) {
    static const std::vector<uint8_t> kPlaces = allPlaces();
    const uint8_t place = kPlaces[r.opcode];
    if (place != kNone) {
        const StateCommand& command = kCommands[place];
        return {command.cell, command.check(r) && r.sizeBytes <= kStateWords * 4, command.cell == kMatrixMode};
    }
    const uint32_t what = argumentWord(r, 0), cap = contextCap(what);
    if (cap != kNoCell || isIndexedCap(r.opcode))
        return {cap, isCap(r.opcode) && r.sizeBytes <= kStateWords * 4, false};
    return {unitCap(what, unit), r.sizeBytes <= kStateWords * 4, true};
}

} // namespace mural::filter
