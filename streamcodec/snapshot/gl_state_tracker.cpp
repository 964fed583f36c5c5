#include "streamcodec/snapshot/gl_state_tracker.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <cstring>

#include "gl_opcodes.hpp"
#include "streamcodec/wire/record_blobs.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::snapshot {
namespace {

bool takesArrays(uint16_t opcode) {
    switch (effectRuleOf(opcode).kind) {
    case EffectKind::Draw:
    case EffectKind::Vertex:
    case EffectKind::Blit:
    case EffectKind::TexCopyImage:
    case EffectKind::TexCopySubImage:
    case EffectKind::CallList:
    case EffectKind::CallLists: return true;
    default: return false;
    }
}

} // namespace

bool namesAt(const RecordView& r, size_t word, std::vector<uint32_t>& names) {
    const uint32_t bytes = argumentWord(r, word);
    if (bytes > record::kInlineBytes || (word + 1) * 4 + bytes > r.arguments.size()) return false;
    names.resize(bytes / 4);
    if (!names.empty()) std::memcpy(names.data(), r.arguments.data() + (word + 1) * 4, names.size() * 4);
    return true;
}

void GlStateTracker::clientGone(uint32_t client) {
    clients_.erase(client);
    std::erase_if(streams_, [client](const auto& s) { return wire::clientOf(s.first) == client; });
}

void GlStateTracker::forEachKey(const std::function<void(Key)>& take) const {
    const auto takeObjects = [&](const Objects& objects) {
        for (const auto& [id, object] : objects) take(object->key), take(object->images);
    };
    for (const auto& [id, stream] : streams_) take(stream.key);
    for (const auto& [id, client] : clients_) {
        take(client.key);
        for (const Key key : {client.state, client.pictures, client.results}) take(key);
        for (const auto& [number, window] : client.windows) take(window.key), take(window.picture);
        for (const auto& [number, context] : client.contexts) {
            take(context.key);
            take(context.cells);
            take(context.group->key);
            take(context.group->images);
            takeObjects(context.own);
            takeObjects(context.group->objects);
            for (const auto& object : context.group->gone) take(object->key), take(object->images);
            for (const auto* stack : {&context.attribs, &context.clientAttribs})
                for (const SavedAttribs& saved : *stack) {
                    take(saved.key);
                    for (const auto& [key, bits] : saved.touched) take(key);
                }
        }
    }
}

bool GlStateTracker::record(uint32_t stream, const RecordView& r, Effect& effect) {
    ClientNames& client = clients_[wire::clientOf(stream)];
    if (client.key == kNoKey) {
        client.key = part(kNoKey, Part::Client, wire::clientOf(stream));
        client.state = part(client.key, Part::State);
        client.pictures = part(client.key, Part::Pictures);
        client.results = part(client.key, Part::Results);
    }
    StreamNames& thread = streams_[stream];
    if (thread.key == kNoKey) thread.key = part(client.state, Part::Stream, stream);
    if (r.opcode == wire::kOpBlobBegin) thread.blobBytes.push_back(argumentWide(r, 0));
    if (r.opcode == wire::kOpBlobBegin || r.opcode == wire::kOpBlobData) return false;
    uint64_t blobBytes = 0;
    if (!thread.blobBytes.empty()) {
        blobBytes = thread.blobBytes.front();
        const size_t taken = std::min(thread.blobBytes.size(), wire::blobsTakenBy(r));
        thread.blobBytes.erase(thread.blobBytes.begin(), thread.blobBytes.begin() + static_cast<std::ptrdiff_t>(taken));
        if (!thread.blobBytes.empty()) effect.always = true; // they are another's
    }
    if (r.opcode == wire::kOpClientArrays || r.opcode == wire::kOpFillWindow) {
        thread.expectsDraw = true;
        return false;
    }
    const auto context = client.contexts.find(thread.context);
    At at{stream, client, thread, context == client.contexts.end() ? nullptr : &context->second, effect, blobBytes};
    if (thread.expectsDraw && !takesArrays(r.opcode)) effect.always = true;
    thread.expectsDraw = false;
    if (r.opcode < wire::kFirstGlOpcode)
        own(at, r);
    else if (at.context != nullptr)
        gl(at, r);
    return !thread.inPrimitive && thread.list == 0 && thread.blobBytes.empty();
}

// Reads everything that a draw may depend on. Pictures that are neither its textures nor its targets are excluded.
void GlStateTracker::readState(At& at) {
    at.effect.read(at.context != nullptr && (at.context->usesFront || at.context->limits.conditional)
                       ? at.client.key
                       : at.client.state);
}
void GlStateTracker::readAll(At& at) { at.effect.read(at.client.key); }

// ---- Mural's own records

void GlStateTracker::own(At& at, const RecordView& r) {
    const uint32_t first = argumentWord(r, 0);
    switch (r.opcode) {
    case wire::kOpCreateContext: return createContext(at, r);
    case wire::kOpDestroyContext: return destroyContext(at, r);
    case wire::kOpMakeCurrent: return makeCurrent(at, r);
    case wire::kOpWindow: return window(at, r);
    case wire::kOpDestroyWindow: {
        const auto found = at.client.windows.find(first);
        if (found == at.client.windows.end()) return;
        for (const Key key : {found->second.key, found->second.picture}) {
            at.effect.add(key, Mode::Forget);
            at.effect.add(key, Mode::Close);
        }
        at.client.windows.erase(found);
        return;
    }
    case wire::kOpFrontPicture: at.thread.inPrimitive = false; return; // shows the present picture
    case wire::kOpSwap: {
        const auto found = at.client.windows.find(first);
        at.thread.inPrimitive = false;
        if (found == at.client.windows.end()) return;
        at.effect.kill(part(part(at.client.results, Part::Window, first), Part::Front));
        at.effect.read(part(found->second.picture, Part::Color));
        at.effect.read(found->second.key);
        at.effect.read(at.thread.key);
        return;
    }
    case wire::kOpRequestPixels:
    case wire::kOpRequestTexImage:
    case wire::kOpFinish: return drawGathered(at); // the program already has the reply
    case wire::kOpRequestBuffer:
    case wire::kOpRequestQuery:
    case wire::kOpRequestProgram: return;
    case wire::kOpProgramLayout:
    case wire::kOpProgramRecipe:
        if (at.context == nullptr) return;
        if (Object* program = find(at, ObjectType::Program, first)) {
            if (r.opcode == wire::kOpProgramLayout)
                at.effect.kill(part(program->key, Part::Layout));
            else
                at.effect.write(part(program->key, Part::Linked)), program->anyUnit = true;
            at.effect.read(part(program->key, Part::Linked));
            at.effect.read(at.thread.key);
            return;
        }
        at.effect.always = true;
        return readAll(at);
    case wire::kOpBufferBytes: return bufferBytes(at, r);
    case wire::kOpBeginConditional:
        if (at.context == nullptr) return;
        at.context->limits.conditional = true;
        at.effect.kill(part(at.context->key, Part::Conditional));
        at.effect.read(at.thread.key);
        return;
    case wire::kOpQueryKnown:
        at.effect.kill(part(at.client.state, Part::QueryKnown, first, at.thread.context));
        at.effect.read(at.thread.key);
        return;
    case wire::kOpErrorReported: // nodes count these records and use no state
        at.effect.always = true;
        return at.effect.read(at.thread.key);
    case wire::kOpCreateImage: {
        const auto owner = at.client.contexts.find(argumentWord(r, 2));
        if (owner != at.client.contexts.end())
            owner->second.group->trackingDisabled = true; // images share the contents of objects
        [[fallthrough]];
    }
    default:
        at.effect.always = true;
        at.effect.read(at.thread.key);
        return readAll(at);
    }
}

void GlStateTracker::createContext(At& at, const RecordView& r) {
    const uint32_t id = argumentWord(r, 0);
    const auto sharer = at.client.contexts.find(argumentWord(r, 1));
    if (id == 0 || at.client.contexts.contains(id)) return; // an error: the node's stays
    ContextNames context;
    context.key = part(at.client.state, Part::Context, id, ++at.client.incarnations);
    context.cells = part(context.key, Part::Cells);
    context.api = static_cast<wire::Api>(argumentWord(r, 2));
    if (sharer == at.client.contexts.end()) {
        context.group = std::make_shared<Group>();
        context.group->key = part(at.client.state, Part::Group, id, at.client.incarnations);
        context.group->images = part(at.client.pictures, Part::Group, id, at.client.incarnations);
        at.effect.kill(context.group->key);
        at.effect.kill(context.group->images);
    } else {
        context.group = sharer->second.group;
        at.effect.read(part(sharer->second.key, Part::Made));
    }
    ++context.group->contexts;
    at.effect.kill(context.key);
    at.client.contexts.emplace(id, std::move(context));
}

void GlStateTracker::destroyContext(At& at, const RecordView& r) {
    const auto found = at.client.contexts.find(argumentWord(r, 0));
    if (found == at.client.contexts.end()) return;
    ContextNames& context = found->second;
    const bool current = std::ranges::any_of(streams_, [&](const auto& s) {
        return wire::clientOf(s.first) == wire::clientOf(at.stream) && s.second.context == found->first;
    });
    if (current) { // it exists until another context is current, so its state stays
        at.effect.always = true;
        return;
    }
    At of{at.stream, at.client, at.thread, &context, at.effect, 0};
    for (auto& [slot, object] : context.bindings) retain(of, object, nullptr);
    for (auto& [slot, query] : context.queries) retain(of, query, nullptr);
    for (auto& [name, object] : context.own) {
        for (auto& [slot, retained] : object->references) retain(of, retained, nullptr);
        for (auto& [point, attachment] : object->attachments) retain(of, attachment.object, nullptr);
    }
    at.effect.add(context.key, Mode::Forget);
    if (--context.group->contexts == 0) {
        at.effect.add(context.group->key, Mode::Forget);
        at.effect.add(context.group->images, Mode::Forget);
    }
    at.effect.add(context.key, Mode::Close);
    at.client.contexts.erase(found);
}

void GlStateTracker::makeCurrent(At& at, const RecordView& r) {
    const uint32_t id = argumentWord(r, 0);
    if (at.thread.inPrimitive || at.thread.list != 0) at.effect.always = true;
    at.thread.inPrimitive = false;
    at.thread.list = 0;
    if (at.context != nullptr && at.thread.context != id) {
        at.effect.kill(part(at.context->key, Part::Owner));
        at.context->lastStream = at.stream;
    }
    at.thread.context = id;
    at.thread.draw = argumentWord(r, 1);
    at.thread.read = argumentWord(r, 2);
    at.effect.kill(at.thread.key);
    const auto found = at.client.contexts.find(id);
    if (found == at.client.contexts.end()) return;
    ContextNames& context = found->second;
    at.effect.kill(part(context.key, Part::Owner));
    at.effect.read(part(context.key, Part::Made));
    // Another thread must have let go of it.
    if (context.lastStream != 0 && context.lastStream != at.stream) at.effect.read(part(context.key, Part::Owner));
    context.lastStream = at.stream;
    for (const uint32_t window : {at.thread.draw, at.thread.read}) {
        const auto bound = at.client.windows.find(window);
        if (bound != at.client.windows.end()) at.effect.read(part(bound->second.key, Part::Config));
    }
    if (context.everCurrent) return;
    context.everCurrent = true;
    // Viewport and scissor take the window's size, and its first buffer is chosen.
    at.effect.write(part(context.key, Part::First));
    const auto drawn = at.client.windows.find(at.thread.draw);
    if (drawn != at.client.windows.end() && !drawn->second.config.doubleBuffer && context.api == wire::Api::Desktop)
        context.limits.drawBuffer = GL_FRONT;
}

void GlStateTracker::window(At& at, const RecordView& r) {
    const uint32_t id = argumentWord(r, 0);
    wire::WindowConfig config{};
    if (r.arguments.size() >= 4 + sizeof config) std::memcpy(&config, r.arguments.data() + 4, sizeof config);
    WindowNames& window = at.client.windows[id];
    const bool fresh = window.key == kNoKey;
    if (fresh) {
        window.key = part(at.client.state, Part::Window, id, ++at.client.incarnations);
        window.picture = part(at.client.pictures, Part::Window, id, at.client.incarnations);
    }
    window.config = config;
    if (fresh) {
        at.effect.kill(window.key);
        return at.effect.kill(window.picture);
    }
    at.effect.kill(part(window.key, Part::Config));
    at.effect.kill(window.picture);               // it gets another surface
    at.effect.read(part(window.key, Part::Name)); // the window must exist
}

// ---- GL

void GlStateTracker::unknown(At& at, bool names) {
    at.effect.always = true;
    readAll(at);
    at.context->group->trackingDisabled = true;
    at.context->unknown = at.context->unknown || names;
}

void GlStateTracker::gl(At& at, const RecordView& r) {
    const size_t before = at.effect.entries.size();
    execute(at, r);
    // Moves reads after the keys that the command replaces: the new values do not depend on the old ones. Calls of
    // lists are sequences of commands and keep their order.
    const EffectKind kind = effectRuleOf(r.opcode).kind;
    if (kind != EffectKind::CallList && kind != EffectKind::CallLists)
        std::stable_partition(at.effect.entries.begin() + static_cast<std::ptrdiff_t>(before), at.effect.entries.end(),
                              [](const EffectEntry& e) { return e.mode != Mode::Read; });
    // Any effect depends on the current context of the stream.
    if (at.effect.always || at.effect.entries.size() > before) at.effect.read(at.thread.key);
}

void GlStateTracker::execute(At& at, const RecordView& r) {
    const EffectRule& rule = effectRuleOf(r.opcode);
    if (at.context->unknown) return unknown(at, true);
    if (at.thread.list != 0 && rule.kind != EffectKind::EndList) return compiled(at, r);
    if (hasSideEffects(at, rule, r)) return;
    switch (rule.kind) {
    case EffectKind::Unknown: return unknown(at, false);
    case EffectKind::UnknownNames: return unknown(at, true);
    case EffectKind::Nothing: return;
    case EffectKind::NewList:
    case EffectKind::EndList:
    case EffectKind::GenLists:
    case EffectKind::DeleteList:
    case EffectKind::CallList:
    case EffectKind::CallLists: return lists(at, rule, r);
    case EffectKind::Begin: at.thread.inPrimitive = at.context->callDepth == 0; return draw(at);
    case EffectKind::End: at.thread.inPrimitive = false; return;
    case EffectKind::Vertex:
        if (!at.thread.inPrimitive) draw(at);
        return;
    case EffectKind::Draw:
    case EffectKind::Compute:
    case EffectKind::Barrier:
    case EffectKind::ReadsPicture:
    case EffectKind::Clear:
    case EffectKind::ClearBuffer:
    case EffectKind::Blit: return clear(at, rule, r);
    case EffectKind::QueryBegin:
    case EffectKind::QueryEnd:
    case EffectKind::QueryCounter:
    case EffectKind::FeedbackBegin:
    case EffectKind::FeedbackEnd:
    case EffectKind::ConditionalEnd: return queries(at, rule, r);
    case EffectKind::Gen:
    case EffectKind::Create:
    case EffectKind::Delete:
    case EffectKind::SyncMake:
    case EffectKind::SyncDelete: return objects(at, rule, r);
    case EffectKind::Bind:
    case EffectKind::BindIndexed:
    case EffectKind::UseProgram: return bind(at, rule, r);
    case EffectKind::ArrayPointer:
    case EffectKind::ArraySet:
    case EffectKind::ArrayNamedSet:
    case EffectKind::ClientCap: return arrays(at, rule, r);
    case EffectKind::BufferData:
    case EffectKind::BufferSubData:
    case EffectKind::BufferOther: return buffers(at, rule, r);
    case EffectKind::TexParameter:
    case EffectKind::TexImage:
    case EffectKind::TexStorage:
    case EffectKind::TexSubImage:
    case EffectKind::TexCopyImage:
    case EffectKind::TexCopySubImage:
    case EffectKind::TexMipmaps:
    case EffectKind::TexBuffer:
    case EffectKind::TexView: return textures(at, rule, r);
    case EffectKind::Handle:
    case EffectKind::HandleResident: return handles(at, rule, r);
    case EffectKind::TexPages:
    case EffectKind::BufferPages: return pages(at, rule, r);
    case EffectKind::RenderbufferStorage:
    case EffectKind::FramebufferAttach:
    case EffectKind::FramebufferSet:
    case EffectKind::FramebufferNamed:
    case EffectKind::DrawBuffers: return framebuffers(at, rule, r);
    case EffectKind::NamedSet:
    case EffectKind::PipelineSet:
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
    case EffectKind::ArbProgram: return shaders(at, rule, r);
    case EffectKind::MatrixLoad:
    case EffectKind::MatrixChange:
    case EffectKind::MatrixPush:
    case EffectKind::MatrixPop: return matrix(at, rule, r);
    default: return state(at, rule, r);
    }
}

} // namespace mural::snapshot
