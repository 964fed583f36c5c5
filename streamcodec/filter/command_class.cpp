#include "streamcodec/filter/command_class.hpp"

#include "streamcodec/wire/control_records.hpp"

namespace mural::filter {
namespace {

CommandClass ofDeferral(Deferral deferral) {
    switch (deferral) {
    case Deferral::Bind: return CommandClass::Bind;
    case Deferral::Object: return CommandClass::Object;
    case Deferral::UseAll: return CommandClass::UseAll;
    default: return CommandClass::Unknown;
    }
}

CommandClass ofFamily(const EffectRule& rule) {
    switch (rule.kind) {
    case EffectKind::Nothing:
    case EffectKind::Cell:
    case EffectKind::CellOfMatrix:
    case EffectKind::UnitCell:
    case EffectKind::UnitCellOfMatrix:
    case EffectKind::Cap:
    case EffectKind::ClientCap:
    case EffectKind::ClientCell:
    case EffectKind::Attribute:
    case EffectKind::Color:
    case EffectKind::Limit:
    case EffectKind::PatternedCell: // data in a buffer is in a pixel buffer, whose uploads are not deferred
    case EffectKind::MatrixMode:
    case EffectKind::ListBase:
    case EffectKind::ArraySet: // except the exceptions of the registry (ofDeferral)
    case EffectKind::ArrayNamedSet:
    case EffectKind::MatrixLoad:
    case EffectKind::MatrixChange:
    case EffectKind::MatrixPush:
    case EffectKind::MatrixPop:
    case EffectKind::GenLists:
    case EffectKind::DeleteList: // a later list with the same name replaces it
    case EffectKind::FramebufferSet:
    case EffectKind::DrawBuffers:
    case EffectKind::RenderbufferStorage:
    case EffectKind::ShaderSet:
    case EffectKind::ShaderCompile:
    case EffectKind::ArbProgram:
    case EffectKind::SyncMake:
    case EffectKind::SyncDelete:
    case EffectKind::Clear: // render targets: uploads to textures that are render targets are not deferred
    case EffectKind::ClearBuffer:
    case EffectKind::Blit:
    case EffectKind::Barrier:
    case EffectKind::Vertex: // within a glBegin, which has flushed already
    case EffectKind::QueryBegin:
    case EffectKind::QueryEnd:
    case EffectKind::QueryCounter:
    case EffectKind::ConditionalEnd: return CommandClass::Pass;
    case EffectKind::CellOfAll: // the raster position passes through shaders
    case EffectKind::Draw:
    case EffectKind::Compute: return CommandClass::Use;
    case EffectKind::Begin: return CommandClass::Begin;
    case EffectKind::End: return CommandClass::End;
    case EffectKind::ActiveTexture:
    case EffectKind::ClientActiveTexture:
    case EffectKind::AttribPush:
    case EffectKind::AttribPop:
    case EffectKind::ClientPush:
    case EffectKind::ClientPop:
    case EffectKind::Bind:
    case EffectKind::BindIndexed:
    case EffectKind::UseProgram:
    case EffectKind::ArrayPointer:
    case EffectKind::Gen:
    case EffectKind::Create:
    case EffectKind::Delete:
    case EffectKind::ProgramDelete:
    case EffectKind::FramebufferAttach:
    case EffectKind::FramebufferNamed:
    case EffectKind::PipelineSet:
    case EffectKind::TexBuffer: return CommandClass::Bind;
    case EffectKind::NamedSet: return rule.type == ObjectType::Texture ? CommandClass::Object : CommandClass::Pass;
    case EffectKind::TexParameter:
    case EffectKind::TexMipmaps:
    case EffectKind::TexCopyImage:
    case EffectKind::TexCopySubImage:
    case EffectKind::ShaderDelete:
    case EffectKind::ProgramAttach:
    case EffectKind::ProgramDetach:
    case EffectKind::ProgramSet:
    case EffectKind::ProgramLink:
    case EffectKind::ProgramUniform: return CommandClass::Object;
    case EffectKind::TexImage:
    case EffectKind::TexStorage:
    case EffectKind::TexSubImage:
    case EffectKind::BufferData:
    case EffectKind::BufferSubData:
    case EffectKind::Uniform: return CommandClass::Upload;
    case EffectKind::NewList:
    case EffectKind::EndList:
    case EffectKind::CallList:
    case EffectKind::CallLists: return CommandClass::List;
    default: return CommandClass::Unknown; // transform feedback, images of other objects, commands without an effect
    }
}

Binding bindingOf(ObjectType type) {
    switch (type) {
    case ObjectType::Texture: return Binding::Texture;
    case ObjectType::Buffer: return Binding::Buffer;
    case ObjectType::VertexArray: return Binding::VertexArray;
    case ObjectType::Framebuffer: return Binding::Framebuffer;
    default: return Binding::Nothing;
    }
}

Binding bindingOf(EffectKind effect, ObjectType type) {
    switch (effect) {
    case EffectKind::Cap: return Binding::Cap;
    case EffectKind::ActiveTexture: return Binding::Unit;
    case EffectKind::ClientActiveTexture: return Binding::ClientUnit;
    case EffectKind::AttribPush: return Binding::PushAttribs;
    case EffectKind::AttribPop: return Binding::PopAttribs;
    case EffectKind::ClientPush: return Binding::PushClientAttribs;
    case EffectKind::ClientPop: return Binding::PopClientAttribs;
    case EffectKind::UseProgram: return Binding::Program;
    case EffectKind::BindIndexed: return Binding::Indexed;
    case EffectKind::ArrayPointer: return Binding::Pointer;
    case EffectKind::ArraySet:
    case EffectKind::ArrayNamedSet: return Binding::ArrayBuffers;
    case EffectKind::Gen:
    case EffectKind::Create: return Binding::Generate;
    case EffectKind::Delete:
    case EffectKind::ProgramDelete: return Binding::Delete;
    case EffectKind::FramebufferAttach: return Binding::Attach;
    case EffectKind::FramebufferNamed: return Binding::AttachNamed;
    case EffectKind::PipelineSet: return Binding::Pipeline;
    case EffectKind::TexBuffer: return Binding::TextureBuffer;
    case EffectKind::Bind: return bindingOf(type);
    default: return Binding::Nothing;
    }
}

CommandClass ownClass(uint16_t opcode) {
    switch (opcode) {
    case wire::kOpBlobBegin:
    case wire::kOpBlobData: return CommandClass::Blob;
    case wire::kOpClientArrays:
    case wire::kOpFillWindow: return CommandClass::Arrays;
    case wire::kOpBufferBytes: return CommandClass::Upload;
    default: return CommandClass::Own;
    }
}

// Returns true for requests that do not depend on bindings.
bool requestsPictures(uint16_t opcode) {
    return opcode == wire::kOpSwap || opcode == wire::kOpFrontPicture || opcode == wire::kOpRequestPixels ||
           opcode == wire::kOpRequestQuery || opcode == wire::kOpFinish;
}

constexpr uint8_t kBufferBytesValue = 3; // after buffer and u64 offset

// While a list is compiled, a command that draws and sets no state only matters for the nesting of primitives.
int8_t deeperOf(const CommandKind& kind) {
    if (kind.state != StateRole::None && kind.state != StateRole::Use) return kExamined;
    switch (kind.about) {
    case CommandClass::Pass:
    case CommandClass::Use:
    case CommandClass::Arrays: return 0;
    case CommandClass::Begin: return 1;
    case CommandClass::End: return -1;
    default: return kExamined;
    }
}

FrameRole frameRoleOf(const CommandKind& kind) {
    switch (kind.about) {
    case CommandClass::Pass:
    case CommandClass::Use:
    case CommandClass::Arrays: return FrameRole::Draws;
    case CommandClass::Begin:
    case CommandClass::End: return FrameRole::Binds;
    case CommandClass::Bind:
        if (kind.effect == EffectKind::UseProgram) return FrameRole::Draws;
        return kind.effect == EffectKind::Gen || kind.effect == EffectKind::Create ||
                       kind.effect == EffectKind::Delete || kind.effect == EffectKind::ProgramDelete
                   ? FrameRole::Ends
                   : FrameRole::Binds;
    case CommandClass::List:
        return kind.effect == EffectKind::CallList || kind.effect == EffectKind::CallLists ? FrameRole::Binds
                                                                                           : FrameRole::Ends;
    case CommandClass::Object: // on an object without deferred uploads
        if (kind.small) return FrameRole::Draws;
        return kind.effect == EffectKind::TexParameter || kind.effect == EffectKind::NamedSet ? FrameRole::Binds
                                                                                              : FrameRole::SeenBound;
    case CommandClass::Upload: return kind.small ? FrameRole::Draws : FrameRole::SeenBound;
    case CommandClass::Blob:
    case CommandClass::Own:
    case CommandClass::UseAll: return FrameRole::SeenBound;
    case CommandClass::Unknown: break;
    }
    return FrameRole::Ends;
}

} // namespace

CommandKinds::CommandKinds() {
    for (uint16_t opcode = 0; opcode < op::kLimit; ++opcode) {
        CommandKind& kind = kinds_[opcode];
        kind.state = stateRoleOf(opcode);
        if (opcode < wire::kFirstGlOpcode) {
            kind.about = ownClass(opcode);
            continue;
        }
        const EffectRule& rule = effectRuleOf(opcode);
        kind.effect = rule.kind;
        const Deferral deferral = effectOf(opcode).deferral;
        kind.about = deferral == Deferral::ByEffect ? ofFamily(rule) : ofDeferral(deferral);
        kind.valueWord = rule.valueWord;
    }
    kinds_[wire::kOpBufferBytes].valueWord = kBufferBytesValue;
    for (uint16_t opcode = 0; opcode <= op::kLimit; ++opcode) {
        CommandKind& kind = kinds_[opcode];
        kind.binding = bindingOf(kind.effect, effectRuleOf(opcode).type);
        kind.small = kind.effect == EffectKind::Uniform || kind.effect == EffectKind::ProgramUniform;
        kind.deeper = deeperOf(kind);
        kind.frame = requestsPictures(opcode) ? FrameRole::Seen : frameRoleOf(kind);
        const bool passes = kind.about == CommandClass::Pass;
        const bool examined = kind.about == CommandClass::Bind || kind.about == CommandClass::Use ||
                              kind.effect == EffectKind::CallList || kind.effect == EffectKind::CallLists;
        const auto of = [&](Walk walk) -> Interest& { return interests_[static_cast<size_t>(walk)][opcode]; };
        of(Walk::State) = passes && kind.state == StateRole::None ? Interest::None : Interest::Stop;
        of(Walk::Bindings) = passes || kind.small || kind.effect == EffectKind::UseProgram ? Interest::None
                             : examined                                                    ? Interest::Examine
                                                                                           : Interest::Stop;
        of(Walk::Untracked) =
            kind.about == CommandClass::Own || kind.about == CommandClass::Blob ? Interest::Stop : Interest::None;
    }
}

const CommandKinds& CommandKinds::all() {
    static const CommandKinds kAll;
    return kAll;
}

} // namespace mural::filter
