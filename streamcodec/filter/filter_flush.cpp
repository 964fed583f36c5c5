// Flushing: sends deferred commands before the command that may read them, with their original binding, and restores
// the current binding.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <array>
#include <cstring>

#include "gl_opcodes.hpp"
#include "streamcodec/filter/command_filter.hpp"
#include "streamcodec/wire/record.hpp"

namespace mural::filter {
namespace {

template <size_t Words>
void put(Output& output, size_t from, uint16_t opcode, const std::array<uint32_t, Words>& arguments) {
    std::array<uint32_t, Words + 1> record{};
    record[0] = opcode | static_cast<uint32_t>(Words + 1) << 16;
    std::ranges::copy(arguments, record.begin() + 1);
    output.insert(from, std::as_bytes(std::span(record)));
}

// Uploads needed within this number of frames are not deferred: programs fill buffers before a swap and draw after it.
constexpr uint64_t kSoonFrames = 1;

uint32_t nameOf(const Object* object) { return object == nullptr ? 0 : object->name; }

} // namespace

// Decides whether to defer the first upload of an object.
bool CommandFilter::deferrable(Group& group, Object& object) {
    if (!object.deferral.tries()) return false;
    const bool othersWait =
        !group.deferred.empty() && group.frame - group.deferred.front()->deferredSince > kSoonFrames;
    return othersWait || group.soonUsed.tries();
}

// Handles a draw: flushes the deferred objects that are bound for it.
void CommandFilter::use(At& at) {
    Context& c = at.context;
    if (at.group.deferred.empty() || !c.needs) return;
    c.needs = false;
    std::vector<Object*>& used = used_;
    used.clear();
    const auto take = [&](Object* object) {
        if (object != nullptr && object->waits() && std::ranges::find(used, object) == used.end())
            used.push_back(object);
    };
    for (const TextureUnit& unit : c.units)
        for (Object* const object : unit) take(object);
    for (const auto& [key, object] : c.array->buffers) take(object);
    take(c.array->indices);
    take(c.program);
    if (!used.empty()) release(at.stream, at.output, at.from, used);
}

void CommandFilter::releaseOne(At& at, Object& object) {
    Object* const one = &object;
    if (object.waits()) release(at.stream, at.output, at.from, std::span(&one, 1));
}

// Frees room for this number of bytes by flushing the oldest objects, and some more to amortise the search. Returns
// false if nothing can be flushed.
bool CommandFilter::makeRoom(Stream& stream, Output& output, size_t from, uint64_t sizeBytes) {
    const auto wants = [&] { return counts_.deferredBytes + pendingBytes_ + sizeBytes; };
    if (wants() <= maxBytes_) return true;
    const uint64_t tooMuch = wants() - maxBytes_ / 8 * 7;
    std::vector<Object*> oldest;
    uint64_t sum = 0;
    for (Object* const object : stream.context->group->deferred) {
        if (sum >= tooMuch) break;
        sum += object->deferredBytes + object->uniforms.waitingBytes();
        oldest.push_back(object);
    }
    if (!oldest.empty()) release(stream, output, from, oldest, Because::NoRoom);
    return wants() <= maxBytes_;
}

void CommandFilter::releaseGroup(Stream& stream, Output& output, size_t from) {
    if (stream.context == nullptr || stream.context->group->deferred.empty()) return;
    const std::vector<Object*> all = stream.context->group->deferred;
    release(stream, output, from, all);
}

// Flushes a group in the stream of its own context, between two of its packets.
void CommandFilter::releaseOf(Group& group, Stream& stream, Output& output, size_t from) {
    if (group.deferred.empty()) return;
    Stream& deferringContext = streams_[group.deferringStream];
    // Within glBegin and glEnd of that stream nothing can be inserted: then here, if this stream shares the group.
    const bool here = stream.context != nullptr && stream.context->group.get() == &group;
    if (&deferringContext == &stream || (deferringContext.inPrimitive && here))
        return releaseGroup(stream, output, from);
    if (deferringContext.inPrimitive) return; // stays deferred: no command of another context has come
    Output other(deferringContext.id, {}, otherScratch_, take_);
    releaseGroup(deferringContext, other, 0);
    other.finish();
}

void CommandFilter::releaseElsewhere(Stream& stream) {
    if (stream.context == nullptr || stream.context->group->deferred.empty() ||
        stream.context->group->deferringContext == stream.context)
        return;
    Output none(stream.id, {}, scratch_, take_);
    releaseOf(*stream.context->group, stream, none, 0);
    none.finish();
}

void CommandFilter::releaseAll() {
    for (auto& [id, stream] : streams_) sendStateOf(stream);
    for (auto& [client, contexts] : clients_)
        for (auto& [id, context] : contexts) {
            if (context->group->deferred.empty()) continue;
            Stream nobody;
            Output none(0, {}, scratch_, take_);
            releaseOf(*context->group, nobody, none, 0);
        }
}

// Drops the queue.
void CommandFilter::dropQueue(Group& group, Object& object) {
    for (const Item& item : object.queue) countLeftOut(item.records, item.bytes.size());
    dropWaiting(object.uniforms);
    object.uniforms.send([](std::span<const std::byte>) {});
    emptyQueue(group, object);
}

// Removes the queue after it was sent or dropped.
void CommandFilter::emptyQueue(Group& group, Object& object) {
    ++group.deferredChanges;
    counts_.deferredBytes -= object.deferredBytes;
    object.deferredBytes = 0;
    object.gained = false;
    std::vector<Item>().swap(object.queue);
    std::erase(group.deferred, &object);
}

void CommandFilter::release(Stream& stream, Output& output, size_t from, std::span<Object* const> objects,
                            Because because) {
    Context& c = *stream.context;
    Group& group = *c.group;
    const bool textures = std::ranges::any_of(objects, [](const Object* o) { return o->kind == Kind::Texture; });
    const Object* const unpack = textures ? bufferAt(c, GL_PIXEL_UNPACK_BUFFER) : nullptr;
    if (unpack != nullptr) put<2>(output, from, op::glBindBuffer, {GL_PIXEL_UNPACK_BUFFER, 0});
    for (Object* const object : objects) {
        counts_.deferredBytes -= object->uniforms.waitingBytes();
        if (!loses_)
            sendQueue(c, output, from, *object);
        else
            object->uniforms.send([](std::span<const std::byte>) {});
        const bool soon = group.frame - object->deferredSince <= kSoonFrames && !object->gained;
        if (soon && because == Because::Needed)
            object->deferral.lost();
        else
            object->deferral.won();
        if (object->kind != Kind::Program && because == Because::Needed) group.soonUsed.was(soon);
        emptyQueue(group, *object);
    }
    if (unpack != nullptr) put<2>(output, from, op::glBindBuffer, {GL_PIXEL_UNPACK_BUFFER, unpack->name});
}

void CommandFilter::sendQueue(Context& c, Output& output, size_t from, Object& object) {
    uint32_t target = 0;
    for (const Item& item : object.queue) target = std::max(target, item.target);
    if (object.uniforms.waiting()) target = 1;
    const Object* bound = &object;
    if (target != 0) {
        switch (object.kind) {
        case Kind::Texture:
            target = object.target;
            bound = c.units[c.unit][targetIndex(target)];
            if (bound != &object) put<2>(output, from, op::glBindTexture, {target, object.name});
            break;
        case Kind::Buffer:
            target = GL_ARRAY_BUFFER; // any neutral target: the element array binding would belong to the vertex array
            bound = bufferAt(c, target);
            if (bound != &object) put<2>(output, from, op::glBindBuffer, {target, object.name});
            break;
        case Kind::Program:
            bound = c.program;
            if (bound != &object) put<1>(output, from, op::glUseProgram, {object.name});
        }
    }
    for (Item& item : object.queue) {
        if (object.kind == Kind::Buffer && item.target != 0) {
            uint32_t head = 0;
            std::memcpy(&head, item.bytes.data() + item.recordAt, sizeof head);
            const size_t headBytes = record::headerBytesOf(head);
            std::memcpy(item.bytes.data() + item.recordAt + headBytes, &target, sizeof target);
        }
        output.insert(from, item.bytes);
    }
    object.uniforms.send([&](std::span<const std::byte> record) { output.insert(from, record); });
    if (bound == &object) return;
    switch (object.kind) {
    case Kind::Texture: return put<2>(output, from, op::glBindTexture, {target, nameOf(bound)});
    case Kind::Buffer: return put<2>(output, from, op::glBindBuffer, {target, nameOf(bound)});
    case Kind::Program: return put<1>(output, from, op::glUseProgram, {nameOf(bound)});
    }
}

} // namespace mural::filter
