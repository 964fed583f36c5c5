#include "nodes/replay/engine/command_uses.hpp"

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

} // namespace mural
