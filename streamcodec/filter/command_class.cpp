#include "streamcodec/filter/command_class.hpp"

#include "streamcodec/wire/control_records.hpp"

namespace mural::filter {
namespace {

using trace::Family;
using trace::ObjectType;

CommandClass ofDeferral(Deferral deferral) {
    switch (deferral) {
    case Deferral::Bind: return CommandClass::Bind;
    case Deferral::Object: return CommandClass::Object;
    case Deferral::UseAll: return CommandClass::UseAll;
    default: return CommandClass::Unknown;
    }
}

CommandClass ofFamily(const trace::Rule& rule) {
    switch (rule.family) {
    case Family::Nothing:
    case Family::Cell:
    case Family::CellOfMatrix:
    case Family::UnitCell:
    case Family::UnitCellOfMatrix:
    case Family::Cap:
    case Family::ClientCap:
    case Family::ClientCell:
    case Family::Attribute:
    case Family::Color:
    case Family::Limit:
    case Family::PatternedCell: // data in a buffer is in a pixel buffer, whose uploads are not deferred
    case Family::MatrixMode:
    case Family::ListBase:
    case Family::ArraySet: // except the exceptions of the registry (ofDeferral)
    case Family::ArrayNamedSet:
    case Family::MatrixLoad:
    case Family::MatrixChange:
    case Family::MatrixPush:
    case Family::MatrixPop:
    case Family::GenLists:
    case Family::DeleteList: // a later list with the same name replaces it
    case Family::FramebufferSet:
    case Family::DrawBuffers:
    case Family::RenderbufferStorage:
    case Family::ShaderSet:
    case Family::ShaderCompile:
    case Family::ArbProgram:
    case Family::SyncMake:
    case Family::SyncDelete:
    case Family::Clear: // render targets: uploads to textures that are render targets are not deferred
    case Family::ClearBuffer:
    case Family::Blit:
    case Family::Barrier:
    case Family::Vertex: // within a glBegin, which has flushed already
    case Family::QueryBegin:
    case Family::QueryEnd:
    case Family::QueryCounter:
    case Family::ConditionalEnd: return CommandClass::Pass;
    case Family::CellOfAll: // the raster position passes through shaders
    case Family::Draw:
    case Family::Compute: return CommandClass::Use;
    case Family::Begin: return CommandClass::Begin;
    case Family::End: return CommandClass::End;
    case Family::ActiveTexture:
    case Family::ClientActiveTexture:
    case Family::AttribPush:
    case Family::AttribPop:
    case Family::ClientPush:
    case Family::ClientPop:
    case Family::Bind:
    case Family::BindIndexed:
    case Family::UseProgram:
    case Family::ArrayPointer:
    case Family::Gen:
    case Family::Create:
    case Family::Delete:
    case Family::ProgramDelete:
    case Family::FramebufferAttach:
    case Family::FramebufferNamed:
    case Family::PipelineSet:
    case Family::TexBuffer: return CommandClass::Bind;
    case Family::NamedSet: return rule.type == ObjectType::Texture ? CommandClass::Object : CommandClass::Pass;
    case Family::TexParameter:
    case Family::TexMipmaps:
    case Family::TexCopyImage:
    case Family::TexCopySubImage:
    case Family::ShaderDelete:
    case Family::ProgramAttach:
    case Family::ProgramDetach:
    case Family::ProgramSet:
    case Family::ProgramLink:
    case Family::ProgramUniform: return CommandClass::Object;
    case Family::TexImage:
    case Family::TexStorage:
    case Family::TexSubImage:
    case Family::BufferData:
    case Family::BufferSubData:
    case Family::Uniform: return CommandClass::Upload;
    case Family::NewList:
    case Family::EndList:
    case Family::CallList:
    case Family::CallLists: return CommandClass::List;
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

Binding bindingOf(Family family, ObjectType type) {
    switch (family) {
    case Family::Cap: return Binding::Cap;
    case Family::ActiveTexture: return Binding::Unit;
    case Family::ClientActiveTexture: return Binding::ClientUnit;
    case Family::AttribPush: return Binding::PushAttribs;
    case Family::AttribPop: return Binding::PopAttribs;
    case Family::ClientPush: return Binding::PushClientAttribs;
    case Family::ClientPop: return Binding::PopClientAttribs;
    case Family::UseProgram: return Binding::Program;
    case Family::BindIndexed: return Binding::Indexed;
    case Family::ArrayPointer: return Binding::Pointer;
    case Family::ArraySet:
    case Family::ArrayNamedSet: return Binding::ArrayBuffers;
    case Family::Gen:
    case Family::Create: return Binding::Generate;
    case Family::Delete:
    case Family::ProgramDelete: return Binding::Delete;
    case Family::FramebufferAttach: return Binding::Attach;
    case Family::FramebufferNamed: return Binding::AttachNamed;
    case Family::PipelineSet: return Binding::Pipeline;
    case Family::TexBuffer: return Binding::TextureBuffer;
    case Family::Bind: return bindingOf(type);
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
        if (kind.family == Family::UseProgram) return FrameRole::Draws;
        return kind.family == Family::Gen || kind.family == Family::Create || kind.family == Family::Delete ||
                       kind.family == Family::ProgramDelete
                   ? FrameRole::Ends
                   : FrameRole::Binds;
    case CommandClass::List:
        return kind.family == Family::CallList || kind.family == Family::CallLists ? FrameRole::Binds : FrameRole::Ends;
    case CommandClass::Object: // on an object without deferred uploads
        if (kind.small) return FrameRole::Draws;
        return kind.family == Family::TexParameter || kind.family == Family::NamedSet ? FrameRole::Binds
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
        const trace::Rule& rule = trace::ruleOf(opcode);
        kind.family = rule.family;
        const Deferral deferral = effectOf(opcode).deferral;
        kind.about = deferral == Deferral::ByEffect ? ofFamily(rule) : ofDeferral(deferral);
        kind.valueWord = rule.valueWord;
    }
    kinds_[wire::kOpBufferBytes].valueWord = kBufferBytesValue;
    for (uint16_t opcode = 0; opcode <= op::kLimit; ++opcode) {
        CommandKind& kind = kinds_[opcode];
        kind.binding = bindingOf(kind.family, trace::ruleOf(opcode).type);
        kind.small = kind.family == Family::Uniform || kind.family == Family::ProgramUniform;
        kind.deeper = deeperOf(kind);
        kind.frame = requestsPictures(opcode) ? FrameRole::Seen : frameRoleOf(kind);
        const bool passes = kind.about == CommandClass::Pass;
        const bool examined = kind.about == CommandClass::Bind || kind.about == CommandClass::Use ||
                              kind.family == Family::CallList || kind.family == Family::CallLists;
        const auto of = [&](Walk walk) -> Interest& { return interests_[static_cast<size_t>(walk)][opcode]; };
        of(Walk::State) = passes && kind.state == StateRole::None ? Interest::None : Interest::Stop;
        of(Walk::Bindings) = passes || kind.small || kind.family == Family::UseProgram ? Interest::None
                             : examined                                                ? Interest::Examine
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
