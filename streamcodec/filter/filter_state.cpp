// Redundant state: a setter is deferred until a command needs its state. Setters that are overwritten before, or that
// change nothing, are dropped.
#include <algorithm>
#include <iterator>

#include "gl_opcodes.hpp"
#include "streamcodec/filter/command_filter.hpp"

namespace mural::filter {

void CommandFilter::setDropsRedundant(bool dropsRedundant) {
    if (dropsRedundant == dropsRedundant_) return;
    for (auto& [id, stream] : streams_) leaveSame(stream);
    // Nothing can be inserted within glBegin and glEnd: postponed.
    if (std::ranges::any_of(streams_, [](const auto& s) { return s.second.inPrimitive; })) return;
    for (auto& [id, stream] : streams_) sendStateOf(stream);
    for (auto& [client, contexts] : clients_)
        for (auto& [id, context] : contexts) {
            sendUniformsOf(*context->group);
            // Setters are not tracked in the meantime.
            context->state.forgetAll();
            context->program = nullptr;
            context->programSure = false;
            for (auto& [name, program] : context->group->objects[static_cast<size_t>(Kind::Program)]) program->forget();
        }
    dropsRedundant_ = dropsRedundant;
}

// Called between two packets of the stream that owns the uniforms.
void CommandFilter::sendUniformsOf(Group& group) {
    std::vector<Object*> programs;
    std::ranges::copy_if(group.deferred, std::back_inserter(programs),
                         [](const Object* o) { return o->kind == Kind::Program; });
    Stream& deferringContext = streams_[group.deferringStream];
    if (programs.empty() || deferringContext.context == nullptr) return;
    Output other(deferringContext.id, {}, otherScratch_, take_);
    release(deferringContext, other, 0, programs);
    other.finish();
}

// Returns true if the record is handled: deferred or dropped.
bool CommandFilter::smallState(Stream& stream, Output& output, const RecordView& r, StateRole role, size_t from,
                               const Packet& packet) {
    Context& c = *stream.context;
    const bool sets = role == StateRole::Set, changes = sets || role == StateRole::Change;
    if (stream.list != 0) { // nothing is deferred: glNewList flushed it
        stream.compiled.sets = stream.compiled.sets || changes;
        return false;
    }
    if (!dropsRedundant_) return false; // then nothing is deferred
    if (stream.inPrimitive) {           // an error, unless glBegin was rejected
        if (changes) c.state.forgetAll();
        return false;
    }
    if (!sets) {
        sendState(stream, output, from);
        if (changes && !(r.opcode == op::glCallList && setsNothing(*c.group, wire::argumentWord(r, 0))))
            c.state.forgetAll();
        return false;
    }
    const StateSet set = stateSetOf(r, c.unit);
    if (set.cell == kNoCell) return false;
    if (!set.certain || stream.values > 0 || c.group->untracked) {
        sendState(stream, output, from);
        c.state.forget(set.cell);
        return false;
    }
    const auto outcome = c.state.set(set.cell, packet.subspan(r.offset, r.sizeBytes), !set.atOnce);
    countFate(outcome, r.sizeBytes);
    if (outcome.fate == Disposition::Goes) return false;
    output.drop(r.offset, r.offset + r.sizeBytes);
    if (counts_.deferredBytes + pendingBytes_ > maxBytes_) sendState(stream, output, r.offset + r.sizeBytes);
    return true;
}

void CommandFilter::countFate(const SetResult& outcome, size_t sizeBytes) {
    countLeftOut(outcome.gone, outcome.goneBytes);
    if (outcome.fate == Disposition::Goes) return;
    counts_.deferredBytes += sizeBytes;
    counts_.deferredBytes -= outcome.goneBytes;
    if (outcome.fate == Disposition::Waits) ++counts_.deferredRecords;
}

bool CommandFilter::setsNothing(const Group& group, uint32_t list) const {
    const auto found = group.lists.find(list);
    return found != group.lists.end() && !found->second.sets && !found->second.calls;
}

void CommandFilter::sendState(Stream& stream, Output& output, size_t from) {
    if (stream.context == nullptr || !stream.context->state.waiting()) return;
    counts_.deferredBytes -= stream.context->state.waitingBytes();
    stream.context->state.send([&](std::span<const std::byte> record) {
        if (!loses_) output.insert(from, record);
    });
}

// Called between two packets of the stream.
void CommandFilter::sendStateOf(Stream& stream) {
    if (stream.context == nullptr || !stream.context->state.waiting()) return;
    Output other(stream.id, {}, otherScratch_, take_);
    sendState(stream, other, 0);
    other.finish();
}

} // namespace mural::filter
