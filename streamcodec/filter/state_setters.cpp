#include "streamcodec/filter/state_setters.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <array>
#include <bit>

#include "streamcodec/command_effects.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/effect_rules.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::filter {
namespace {

using wire::argumentWord;
using wire::RecordView;

constexpr uint32_t kFirstCap = 64; // after the cells of StateCell
constexpr uint32_t kFirstUnitCap = 128, kCapsOfUnit = 16;
constexpr uint32_t kUnitsWithCaps = 8; // fixed-function texture units, as many as drivers have

// ---- checks that every GL accepts a value

bool within(uint32_t value, uint32_t first, uint32_t last) { return value >= first && value <= last; }
bool isFactor(uint32_t factor, bool ofSource) {
    return factor <= GL_ONE || within(factor, GL_SRC_COLOR, GL_ONE_MINUS_DST_COLOR) ||
           within(factor, GL_CONSTANT_COLOR, GL_ONE_MINUS_CONSTANT_ALPHA) ||
           (ofSource && factor == GL_SRC_ALPHA_SATURATE); // not valid as a destination factor in every GL
}
bool isEquation(uint32_t e) { return e == GL_FUNC_ADD || e == GL_FUNC_SUBTRACT || e == GL_FUNC_REVERSE_SUBTRACT; }
bool isStencilOperation(uint32_t operation) {
    constexpr std::array<uint32_t, 8> kAll{GL_ZERO, GL_KEEP,   GL_REPLACE,   GL_INCR,
                                           GL_DECR, GL_INVERT, GL_INCR_WRAP, GL_DECR_WRAP};
    return std::ranges::count(kAll, operation) > 0;
}
template <class Check> bool allWords(const RecordView& r, Check check) {
    for (size_t i = 0; i < r.arguments.size() / 4; ++i)
        if (!check(argumentWord(r, i), i)) return false;
    return true;
}

bool accepts(StateCheck check, const RecordView& r) {
    const uint32_t first = argumentWord(r, 0);
    const auto value = std::bit_cast<float>(first);
    switch (check) {
    case StateCheck::Any: return true;
    case StateCheck::Part: return false;
    case StateCheck::Comparison: return within(first, GL_NEVER, GL_ALWAYS);
    case StateCheck::BlendFactors: return allWords(r, [](uint32_t w, size_t i) { return isFactor(w, i % 2 == 0); });
    case StateCheck::BlendEquations: return allWords(r, [](uint32_t w, size_t) { return isEquation(w); });
    case StateCheck::StencilOperations: return allWords(r, [](uint32_t w, size_t) { return isStencilOperation(w); });
    case StateCheck::LogicOperation: return within(first, GL_CLEAR, GL_SET);
    case StateCheck::Rectangle:
        return static_cast<int32_t>(argumentWord(r, 2)) >= 0 && static_cast<int32_t>(argumentWord(r, 3)) >= 0;
    case StateCheck::Face: return within(first, GL_FRONT, GL_BACK) || first == GL_FRONT_AND_BACK;
    case StateCheck::Winding: return within(first, GL_CW, GL_CCW);
    case StateCheck::BothFaces: return first == GL_FRONT_AND_BACK && within(argumentWord(r, 1), GL_POINT, GL_FILL);
    case StateCheck::ShadeModel: return within(first, GL_FLAT, GL_SMOOTH);
    case StateCheck::VertexConvention: return within(first, GL_FIRST_VERTEX_CONVENTION, GL_LAST_VERTEX_CONVENTION);
    case StateCheck::ThinLine: return value > 0 && value <= 1;
    case StateCheck::Positive: return value > 0;
    case StateCheck::MatrixMode: return within(first, GL_MODELVIEW, GL_TEXTURE);
    }
    return false;
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

// ---- roles

StateRole ofFamily(uint16_t opcode) {
    if (effectOf(opcode).cell != StateCell::None) return StateRole::Set;
    switch (effectRuleOf(opcode).kind) {
    case EffectKind::Cap: return StateRole::Set;
    case EffectKind::Cell: return hasTrait(opcode, Trait::StandsAlone) ? StateRole::None : StateRole::Change;
    case EffectKind::Nothing:
    case EffectKind::CellOfMatrix:
    case EffectKind::UnitCell:
    case EffectKind::UnitCellOfMatrix:
    case EffectKind::ClientCap:
    case EffectKind::ClientCell:
    case EffectKind::Attribute:
    case EffectKind::Color:
    case EffectKind::PatternedCell:
    case EffectKind::ActiveTexture:
    case EffectKind::ClientActiveTexture:
    case EffectKind::ListBase:
    case EffectKind::MatrixLoad:
    case EffectKind::MatrixChange:
    case EffectKind::MatrixPush:
    case EffectKind::MatrixPop:
    case EffectKind::ClientPush:
    case EffectKind::ClientPop:
    case EffectKind::Gen:
    case EffectKind::Create:
    case EffectKind::GenLists:
    case EffectKind::Delete:
    case EffectKind::DeleteList:
    case EffectKind::Bind:
    case EffectKind::BindIndexed:
    case EffectKind::UseProgram:
    case EffectKind::ArrayPointer:
    case EffectKind::ArraySet:
    case EffectKind::ArrayNamedSet:
    case EffectKind::BufferData:
    case EffectKind::BufferSubData:
    case EffectKind::TexParameter:
    case EffectKind::TexImage:
    case EffectKind::TexStorage:
    case EffectKind::TexSubImage:
    case EffectKind::TexMipmaps:
    case EffectKind::TexBuffer:
    case EffectKind::RenderbufferStorage:
    case EffectKind::NamedSet:
    case EffectKind::FramebufferAttach:
    case EffectKind::FramebufferSet:
    case EffectKind::FramebufferNamed:
    case EffectKind::DrawBuffers:
    case EffectKind::ShaderSet:
    case EffectKind::ShaderCompile:
    case EffectKind::ProgramAttach:
    case EffectKind::ProgramDetach:
    case EffectKind::ProgramSet:
    case EffectKind::ProgramLink:
    case EffectKind::ProgramDelete:
    case EffectKind::ShaderDelete:
    case EffectKind::Uniform:
    case EffectKind::ProgramUniform:
    case EffectKind::PipelineSet:
    case EffectKind::ArbProgram:
    case EffectKind::SyncMake:
    case EffectKind::SyncDelete:
    case EffectKind::Barrier:
    case EffectKind::Vertex:
    case EffectKind::End:
    case EffectKind::EndList:
    case EffectKind::QueryBegin:
    case EffectKind::QueryEnd:
    case EffectKind::QueryCounter: return StateRole::None;
    case EffectKind::CellOfAll:
    case EffectKind::Draw:
    case EffectKind::Compute:
    case EffectKind::ReadsPicture:
    case EffectKind::Clear:
    case EffectKind::ClearBuffer:
    case EffectKind::Blit:
    case EffectKind::TexCopyImage:
    case EffectKind::TexCopySubImage:
    case EffectKind::Begin:
    case EffectKind::NewList:
    case EffectKind::AttribPush:
    case EffectKind::FeedbackBegin:
    case EffectKind::FeedbackEnd:
    case EffectKind::ConditionalEnd: return StateRole::Use;
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

} // namespace

StateRole stateRoleOf(uint16_t opcode) { return opcode < wire::kFirstGlOpcode ? ofOwn(opcode) : ofFamily(opcode); }

StateSet stateSetOf(const RecordView& r, uint32_t unit) {
    const CommandEffect& effect = effectOf(r.opcode);
    const bool fits = r.sizeBytes <= kStateWords * 4;
    if (effect.cell != StateCell::None)
        return {static_cast<uint32_t>(effect.cell), fits && accepts(effect.check, r),
                effect.cell == StateCell::MatrixMode};
    const uint32_t what = argumentWord(r, 0), cap = contextCap(what);
    const bool indexed = hasTrait(r.opcode, Trait::Indexed);
    if (cap != kNoCell || indexed) return {cap, !indexed && fits, false};
    return {unitCap(what, unit), fits, true};
}

} // namespace mural::filter
