#include "streamcodec/filter/command_filter.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <utility>

#include "gl_opcodes.hpp"
#include "streamcodec/wire/record_blobs.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::filter {

using wire::argumentWord;

namespace {

constexpr uint64_t kMaxValueBytes = uint64_t{96} << 20; // longer blobs are not buffered

} // namespace

CommandFilter::CommandFilter(uint64_t maxBytes, Take take)
    : maxBytes_(maxBytes),
      take_([this, take = std::move(take)](uint32_t to, std::span<const std::byte> bytes, const RecordOffsets* walked) {
          counts_.outBytes += bytes.size();
          take(to, bytes, walked);
      }) {}

void CommandFilter::countLeftOut(size_t records, size_t sizeBytes) {
    counts_.droppedRecords += records;
    counts_.droppedBytes += sizeBytes;
}

void CommandFilter::add(uint32_t streamId, std::span<const std::byte> payload) {
    Stream& stream = streams_[streamId];
    stream.id = streamId;
    counts_.inBytes += payload.size();
    releaseElsewhere(stream);
    Output output(streamId, payload, scratch_, take_);
    wire::RecordWalk walk(payload);
    RecordView r;
    constexpr size_t kNone = SIZE_MAX;
    size_t valueFrom = stream.values > 0 ? 0 : kNone; // start of the blob's pieces in this packet
    while (true) {
        const bool tracksState = dropsRedundant_ || stream.list != 0;
        if (valueFrom == kNone && stream.same.now == FrameMatcher::Now::Matching) passSame(stream, walk, payload);
        if (valueFrom == kNone && compilesList(stream)) {
            int depth = 0;
            walk.skip([&](uint16_t opcode, size_t times) {
                const int8_t deeper = kinds_[opcode].deeper;
                if (deeper != kExamined) depth += deeper * static_cast<int>(times);
                return deeper != kExamined;
            });
            stream.depth += depth;
        }
        if (valueFrom == kNone) passOthers(stream, output, walk, payload, tracksState);
        if (!walk.next(r)) break;
        const CommandKind& kind = kinds_[r.opcode];
        if (stream.same.now == FrameMatcher::Now::Matching) seeSame(stream, r, kind);
        if (kind.about == CommandClass::Blob) {
            if (valueFrom == kNone) valueFrom = r.offset;
            ++stream.pendingRecords;
            if (r.opcode != wire::kOpBlobBegin) continue;
            const uint64_t sizeBytes = argumentWord(r, 0) | uint64_t{argumentWord(r, 1)} << 32;
            if (stream.values++ == 0) stream.firstValueBytes = sizeBytes;
            stream.valueBytes += sizeBytes;
            continue;
        }
        const size_t from = valueFrom == kNone ? r.offset : valueFrom;
        const bool done = tracksState && kind.state != StateRole::None && stream.context != nullptr &&
                          smallState(stream, output, r, kind.state, from, payload);
        if (!done) record(stream, output, r, kind, from, payload);
        if (stream.values > 0 && kind.about != CommandClass::Upload) stream.waiting.lost();
        if (!stream.pending.empty()) sendPending(stream, output, from);
        if (kind.about != CommandClass::Use) keepSame(stream, r, payload);
        stream.values = stream.pendingRecords = 0;
        stream.valueBytes = 0;
        stream.passing = false;
        valueFrom = kNone;
    }
    if (valueFrom != kNone && !stream.passing) keepPending(stream, output, valueFrom, payload);
    if (stream.same.now == FrameMatcher::Now::Recording) {
        keepRecords(stream, payload);
        stream.same.templateBytes = 0;
    }
    output.finish(walk.whole());
}

// Skips records of no interest. In most programs these are nearly all records. The walk tracks bindings itself. It also
// passes draws that need nothing deferred.
void CommandFilter::passOthers(Stream& stream, Output& output, wire::RecordWalk& walk, const Packet& packet,
                               bool tracksState) {
    using Walk = CommandKinds::Walk;
    const bool isUntracked = stream.context != nullptr && stream.context->group->untracked;
    const CommandKinds::Interests& interests = kinds_.interests(tracksState   ? Walk::State
                                                                : isUntracked ? Walk::Untracked
                                                                              : Walk::Bindings);
    const auto interestOf = [&](uint16_t opcode) { return interests[CommandKinds::placeOf(opcode)]; };
    const bool examines = !tracksState && stream.same.now != FrameMatcher::Now::Matching && bindsHere(stream);
    if (!examines)
        return walk.skip([&](uint16_t opcode, size_t) { return interestOf(opcode) == CommandKinds::Interest::None; });
    walk.pass(interestOf, [&](const RecordView& r) {
        if (stream.context->group->untracked) return false;
        const CommandKind& kind = kinds_[r.opcode];
        Group& group = *stream.context->group;
        if (kind.about != CommandClass::Bind) // a draw, or a display list that may draw
            return (group.deferred.empty() || !stream.context->needs) &&
                   (kind.about == CommandClass::Use || !group.listsBind);
        At at{stream, *stream.context, group, output, r, kind, r.offset, packet};
        bind(at);
        return true;
    });
}

// The packet ends within a blob, before its record: whether it can be deferred is still unknown.
void CommandFilter::keepPending(Stream& stream, Output& output, size_t from, const Packet& packet) {
    Context* const c = stream.context;
    const bool holds = c != nullptr && !c->group->deferred.empty();
    const bool wanted = c != nullptr && !c->group->untracked && stream.list == 0 && !stream.inPrimitive &&
                        stream.valueBytes <= std::min(kMaxValueBytes, maxBytes_ / 2) &&
                        (holds || !stream.waiting.vain() || stream.waiting.tries());
    if (wanted && makeRoom(stream, output, from,
                           stream.valueBytes - std::min<uint64_t>(stream.valueBytes, stream.pending.size()))) {
        const auto rest = packet.subspan(from);
        stream.pending.reserve(stream.valueBytes + stream.valueBytes / 1024 + rest.size());
        stream.pending.insert(stream.pending.end(), rest.begin(), rest.end());
        pendingBytes_ += rest.size();
        return output.drop(from, packet.size());
    }
    // Nothing can be inserted before the record from here on, because blobs are consumed in order.
    if (holds && !stream.inPrimitive) releaseGroup(stream, output, from);
    sendPending(stream, output, from);
    stream.passing = true;
}

void CommandFilter::sendPending(Stream& stream, Output& output, size_t from) {
    if (stream.pending.empty()) return;
    output.insert(from, stream.pending);
    pendingBytes_ -= stream.pending.size();
    std::vector<std::byte>().swap(stream.pending);
}

void CommandFilter::record(Stream& stream, Output& output, const RecordView& r, const CommandKind& kind, size_t from,
                           const Packet& packet) {
    if (kind.about == CommandClass::Own) return own(stream, output, r, from);
    if (stream.context == nullptr || kind.about == CommandClass::Pass) return;
    Group& group = *stream.context->group;
    if (group.untracked) return;
    At at{stream, *stream.context, group, output, r, kind, from, packet};
    gl(at);
}

void CommandFilter::gl(At& at) {
    Stream& stream = at.stream;
    const CommandClass kind = at.kind.about;
    if (stream.list != 0 && kind != CommandClass::List) return compiled(at);
    if (stream.inPrimitive && kind != CommandClass::List) {
        if (kind == CommandClass::End) stream.inPrimitive = false;
        return; // everything else is an error
    }
    switch (kind) {
    case CommandClass::Begin:
        // glBegin with an incomplete framebuffer starts no primitive.
        if (at.context.drawFramebuffer != 0 || at.group.listsBind) releaseGroup(stream, at.output, at.from);
        use(at);
        stream.inPrimitive = argumentWord(at.r, 0) <= 0xE;
        return;
    case CommandClass::Use: return use(at);
    case CommandClass::Arrays: return arrays(at);
    case CommandClass::Bind: return bind(at);
    case CommandClass::Object: return objectCommand(at);
    case CommandClass::Upload: return upload(at);
    case CommandClass::List: return list(at);
    case CommandClass::UseAll:
        releaseGroup(stream, at.output, at.from);
        for (auto& table : at.group.objects)
            for (auto& [name, object] : table) object->forget();
        return;
    case CommandClass::Unknown: return untrack(at);
    default: return;
    }
}

// Nothing can be inserted between these records and their draw, so its inputs are flushed before.
void CommandFilter::arrays(At& at) {
    if (at.group.deferred.empty()) return;
    wire::RecordWalk behind(at.packet.subspan(at.r.offset + at.r.sizeBytes));
    RecordView next;
    const bool draws =
        at.r.opcode == wire::kOpClientArrays && behind.next(next) && kinds_[next.opcode].about == CommandClass::Use;
    if (draws) return use(at);
    releaseGroup(at.stream, at.output, at.from);
}

void CommandFilter::untrack(At& at) {
    releaseGroup(at.stream, at.output, at.from);
    at.group.untracked = true;
    at.group.lists.clear();
    for (auto& table : at.group.objects)
        for (auto& [name, object] : table) object->forget();
}

// ---- Mural's own records

void CommandFilter::own(Stream& stream, Output& output, const RecordView& r, size_t from) {
    switch (r.opcode) {
    case wire::kOpCreateContext: return createContext(stream, r);
    case wire::kOpMakeCurrent: return makeCurrent(stream, output, r, from);
    case wire::kOpDestroyContext: return destroyContext(stream, output, r, from);
    case wire::kOpSwap:
    case wire::kOpFrontPicture:
        stream.inPrimitive = false;
        if (stream.context != nullptr) ++stream.context->group->frame;
        return;
    case wire::kOpRequestTexImage:
    case wire::kOpRequestBuffer:
        if (stream.context != nullptr) releaseGroup(stream, output, from);
        return;
    case wire::kOpProgramLayout:
    case wire::kOpProgramRecipe: {
        if (stream.context == nullptr || stream.context->group->untracked) return;
        static constexpr Packet kNone;
        At at{stream, *stream.context, *stream.context->group, output, r, kinds_[r.opcode], from, kNone};
        Object* const program = make(at.group, Kind::Program, argumentWord(r, 0));
        releaseOne(at, *program);
        program->forget();
        program->target = 1; // linked, so glUseProgram makes it current
        return;
    }
    case wire::kOpCreateImage:
    case wire::kOpDestroyImage: // images share the contents of objects
        for (auto& [id, context] : clients_[wire::clientOf(stream.id)]) {
            releaseOf(*context->group, stream, output, from);
            context->group->untracked = true;
        }
        return;
    default: return; // windows, and requests for pictures or counts
    }
}

void CommandFilter::createContext(Stream& stream, const RecordView& r) {
    auto& contexts = clients_[wire::clientOf(stream.id)];
    const uint32_t id = argumentWord(r, 0);
    if (id == 0 || contexts.contains(id)) return; // an error; the node keeps its context
    auto context = std::make_unique<Context>();
    context->id = id;
    context->arraysNamed.set(0, context->array);
    const auto sharer = contexts.find(argumentWord(r, 1));
    if (sharer != contexts.end()) leaveSameOf(*sharer->second->group);
    context->group = sharer == contexts.end() ? std::make_shared<Group>() : sharer->second->group;
    const uint32_t profile = argumentWord(r, 5), flags = argumentWord(r, 6);
    context->madeByBinding = !(profile & GL_CONTEXT_CORE_PROFILE_BIT);
    // driver messages refer to the current command
    if (flags & GL_CONTEXT_FLAG_DEBUG_BIT) context->group->untracked = true;
    contexts.emplace(id, std::move(context));
}

void CommandFilter::makeCurrent(Stream& stream, Output& output, const RecordView& r, size_t from) {
    stream.inPrimitive = false;
    stream.list = 0;
    auto& contexts = clients_[wire::clientOf(stream.id)];
    const auto found = contexts.find(argumentWord(r, 0));
    Context* const next = found == contexts.end() ? nullptr : found->second.get();
    if (next == stream.context) return;
    if (stream.context != nullptr) releaseOf(*stream.context->group, stream, output, from);
    if (next != nullptr) leaveSameOf(*next->group);
    // another thread's context, or another one of the group
    if (next != nullptr) releaseOf(*next->group, stream, output, from);
    Context* const before = std::exchange(stream.context, next);
    if (before != nullptr && before->destroyed) dropDestroyed(wire::clientOf(stream.id), before);
}

void CommandFilter::destroyContext(Stream& stream, Output& output, const RecordView& r, size_t from) {
    auto& contexts = clients_[wire::clientOf(stream.id)];
    const auto found = contexts.find(argumentWord(r, 0));
    if (found == contexts.end()) return;
    Context* const context = found->second.get();
    releaseOf(*context->group, stream, output, from);
    context->destroyed = true;
    dropDestroyed(wire::clientOf(stream.id), context);
}

void CommandFilter::dropDestroyed(uint32_t client, Context* context) {
    for (const auto& [id, stream] : streams_)
        if (stream.context == context) return; // a current context lives until it is released
    for (auto& [id, stream] : streams_)
        if (stream.same.context == context) stream.same = {};
    clients_[client].erase(context->id);
}

void CommandFilter::clientGone(uint32_t client) {
    const auto ofClient = clients_.find(client);
    if (ofClient != clients_.end()) {
        for (auto& [id, context] : ofClient->second) {
            while (!context->group->deferred.empty()) dropQueue(*context->group, *context->group->deferred.back());
        }
    }
    std::erase_if(streams_, [&](const auto& s) {
        if (wire::clientOf(s.first) != client) return false;
        pendingBytes_ -= s.second.pending.size();
        if (s.second.context != nullptr) dropWaiting(s.second.context->state);
        return true;
    });
    clients_.erase(client);
}

} // namespace mural::filter
