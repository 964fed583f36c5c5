#include "nodes/replay/engine/command_uses.hpp"

#include <vector>

#include <GL/gl.h>

#include "streamcodec/command_effects.hpp"
#include "streamcodec/command_traits.hpp"

namespace mural {

RangeUse rangeUseOf(uint16_t opcode) {
    using enum Trait;
    if (traitsOf(opcode) == 0) return RangeUse::None;
    if (hasTrait(opcode, FeedbackBegin, FeedbackEnd, FeedbackDraw)) return RangeUse::Feedback;
    if (hasTrait(opcode, Draw)) return RangeUse::Draw;
    if (hasTrait(opcode, Vertex)) return RangeUse::Vertex;
    if (hasTrait(opcode, Begin)) return RangeUse::Begin;
    if (hasTrait(opcode, End)) return RangeUse::End;
    if (hasTrait(opcode, OrderState)) return RangeUse::State;
    if (hasTrait(opcode, Clear)) return RangeUse::Clear;
    if (hasTrait(opcode, ClearBuffer, ClearNamed, Pixels, ReadsFramebuffer)) return RangeUse::Read;
    if (hasTrait(opcode, QueryBegin, QueryEnd)) return RangeUse::Query;
    return hasTrait(opcode, ImageBinding, BufferBinding) ? RangeUse::Memory : RangeUse::None;
}

EyeUse eyeUseOf(uint16_t opcode) {
    using enum Trait;
    if (traitsOf(opcode) == 0) return EyeUse::None;
    // An image from client memory is part of the scene. Copies and bitmaps are not.
    const bool isImage = hasTrait(opcode, Pixels) && hasTrait(opcode, AllPlanes) && !hasTrait(opcode, ReadsFramebuffer);
    if (isImage || hasTrait(opcode, Draw, Begin, RasterPosition)) return EyeUse::Draw;
    if (hasTrait(opcode, CallList)) return EyeUse::List;
    if (hasTrait(opcode, Matrix, Viewport)) return EyeUse::Matrix;
    if (hasTrait(opcode, UniformMatrix4)) return EyeUse::Uniform;
    if (hasTrait(opcode, BufferContents)) return EyeUse::Buffer;
    return hasTrait(opcode, FramebufferObject) ? EyeUse::Framebuffer : EyeUse::None;
}

WholeUse wholeUseOf(uint16_t opcode) {
    using enum Trait;
    if (traitsOf(opcode) == 0) return WholeUse::None;
    if (hasTrait(opcode, Pixels, DrawRectangle)) return WholeUse::Copies;
    if (hasTrait(opcode, Draw, Begin, CallList)) return WholeUse::Draw;
    if (hasTrait(opcode, TextureLevel)) return WholeUse::Level;
    if (hasTrait(opcode, TextureLevels)) return WholeUse::Levels;
    if (hasTrait(opcode, TextureAnyLevel)) return WholeUse::AllLevels;
    return hasTrait(opcode, TextureParameter) ? WholeUse::Parameter : WholeUse::None;
}

namespace {

// Cells without any of these bits hold state on which no position and no width depends.
constexpr uint32_t kRasterBits =
    kNoAttribBit | GL_VIEWPORT_BIT | GL_LINE_BIT | GL_POINT_BIT | GL_POLYGON_BIT | GL_TRANSFORM_BIT | GL_ENABLE_BIT;

CullUse cullUseOfBind(ObjectType object) {
    switch (object) {
    case ObjectType::VertexArray: return CullUse::VertexArray;
    case ObjectType::Buffer: return CullUse::IndexBuffer;
    default: return CullUse::None;
    }
}

// Cells of the state of polygons that move no position.
bool keepsPositions(StateCell cell) {
    return cell == StateCell::FrontFace || cell == StateCell::CullFace || cell == StateCell::PolygonOffset;
}

CullUse cullUseByEffect(uint16_t opcode) {
    const CommandEffect& effect = effectOf(opcode);
    switch (effect.kind) {
    case EffectKind::Draw: return CullUse::Draw;
    case EffectKind::MatrixLoad:
    case EffectKind::MatrixChange:
    case EffectKind::MatrixPush:
    case EffectKind::MatrixPop: return CullUse::Matrices;
    case EffectKind::Cell:
    case EffectKind::Limit:
        if (keepsPositions(effect.cell)) return CullUse::None;
        return effect.attribBits == 0 || (effect.attribBits & kRasterBits) ? CullUse::Raster : CullUse::None;
    case EffectKind::MatrixMode: return CullUse::MatrixMode;
    case EffectKind::Cap: return CullUse::Cap;
    case EffectKind::ClientCap:
    case EffectKind::ArrayPointer:
    case EffectKind::ArraySet:
    case EffectKind::ArrayNamedSet:
    case EffectKind::ClientPush:
    case EffectKind::ClientPop: return CullUse::Arrays;
    case EffectKind::Bind: return cullUseOfBind(effect.object);
    case EffectKind::BufferData:
    case EffectKind::BufferSubData:
        return effect.object == ObjectType::Buffer ? CullUse::NamedContents : CullUse::BoundContents;
    case EffectKind::BufferOther:
    case EffectKind::BufferPages:
    case EffectKind::Compute:
    case EffectKind::FeedbackBegin:
    case EffectKind::FeedbackEnd: return CullUse::AllContents;
    case EffectKind::Delete:
        return effect.object == ObjectType::Buffer || effect.object == ObjectType::VertexArray ? CullUse::DeletedBuffers
                                                                                               : CullUse::None;
    case EffectKind::UseProgram: return CullUse::Program;
    case EffectKind::ProgramLink:
    case EffectKind::ProgramDelete:
    case EffectKind::Create: return CullUse::Link;
    case EffectKind::Uniform:
    case EffectKind::ProgramUniform: return CullUse::Uniforms;
    case EffectKind::AttribPop: return CullUse::Pops;
    case EffectKind::CallList:
    case EffectKind::CallLists: return CullUse::List;
    case EffectKind::Begin: return CullUse::Immediate;
    case EffectKind::End: return CullUse::EndImmediate;
    case EffectKind::ReadsPicture: return CullUse::ReadsPicture;
    // State on which neither a position nor the contents of an array depends.
    case EffectKind::Nothing:
    case EffectKind::CellOfMatrix:
    case EffectKind::CellOfAll:
    case EffectKind::UnitCell:
    case EffectKind::UnitCellOfMatrix:
    case EffectKind::ClientCell:
    case EffectKind::Attribute:
    case EffectKind::Color:
    case EffectKind::PatternedCell:
    case EffectKind::ActiveTexture:
    case EffectKind::ClientActiveTexture:
    case EffectKind::ListBase:
    case EffectKind::AttribPush:
    case EffectKind::Gen:
    case EffectKind::GenLists:
    case EffectKind::DeleteList:
    case EffectKind::BindIndexed:
    case EffectKind::TexParameter:
    case EffectKind::TexImage:
    case EffectKind::TexStorage:
    case EffectKind::TexSubImage:
    case EffectKind::TexCopyImage:
    case EffectKind::TexCopySubImage:
    case EffectKind::TexMipmaps:
    case EffectKind::TexBuffer:
    case EffectKind::TexView:
    case EffectKind::RenderbufferStorage:
    case EffectKind::NamedSet:
    case EffectKind::FramebufferAttach:
    case EffectKind::FramebufferSet:
    case EffectKind::FramebufferNamed:
    case EffectKind::DrawBuffers:
    case EffectKind::ShaderSet:
    case EffectKind::ShaderCompile:
    case EffectKind::ShaderDelete:
    case EffectKind::ProgramAttach:
    case EffectKind::ProgramDetach:
    case EffectKind::ProgramSet:
    case EffectKind::PipelineSet:
    case EffectKind::ArbProgram:
    case EffectKind::SyncMake:
    case EffectKind::SyncDelete:
    case EffectKind::Handle:
    case EffectKind::HandleResident:
    case EffectKind::TexPages:
    case EffectKind::Clear:
    case EffectKind::ClearBuffer:
    case EffectKind::Blit:
    case EffectKind::Barrier:
    case EffectKind::Vertex:
    case EffectKind::NewList:
    case EffectKind::EndList:
    case EffectKind::QueryBegin:
    case EffectKind::QueryEnd:
    case EffectKind::ConditionalEnd: return CullUse::None;
    case EffectKind::QueryCounter:
    case EffectKind::Unknown:
    case EffectKind::UnknownNames: break;
    }
    return CullUse::Everything;
}

} // namespace

CullUse cullUseOf(uint16_t opcode) {
    static const std::vector<CullUse> uses = [] {
        std::vector<CullUse> all;
        for (uint32_t i = 0; i < op::kLimit; ++i) all.push_back(cullUseByEffect(static_cast<uint16_t>(i)));
        return all;
    }();
    return opcode < op::kLimit ? uses[opcode] : CullUse::Everything;
}

} // namespace mural
