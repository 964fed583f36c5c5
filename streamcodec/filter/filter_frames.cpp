// Frame matching: a frame that binds the same objects as the previous one is not tracked record by record.
//
// The effect of a record on bindings depends only on its bytes, the current bindings, and the existing objects. A
// template (FrameTemplate) is kept of a frame that ends with the bindings it began with, except for textures. A next
// frame with the same records, and equal bytes of those that bind, ends with the same bindings. At a different record,
// the records before it are tracked at once. Commands deferred throughout the template frame stay deferred: the same
// draws need them no more than before.
#include "gl_opcodes.hpp"
#include "streamcodec/filter/command_filter.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::filter {

namespace {

constexpr size_t kMaxCompared = 1024; // vertex arrays and their bindings, which are compared or copied once per frame
constexpr double kLike = 0.9, kUnlike = 0.5;
constexpr size_t kWorthAMark = 64;   // records that would be tracked in every frame
constexpr uint32_t kMarkFrames = 16; // frames between two marks

bool fewEnough(const Bindings& b) {
    size_t count = b.units.size() * kTextureTargets + b.arrays.size();
    for (const auto& [name, array] : b.arrays) count += array.buffers.size();
    return count <= kMaxCompared;
}

using Textures = std::vector<TextureUnit>;

// A frame, or a part of one, has changed the textures from `begins` to `after`. Returns true if it changes them from
// `now` to `after` too, because it binds every target at which `now` and `begins` differ.
bool leadsTo(const Textures& now, const Textures& begins, const Textures& after) {
    if (now == begins) return true;
    if (now.size() != begins.size() || now.size() != after.size()) return false;
    for (size_t unit = 0; unit < now.size(); ++unit)
        for (size_t i = 0; i < kTextureTargets; ++i)
            if (now[unit][i] != begins[unit][i] && begins[unit][i] == after[unit][i]) return false;
    return true;
}

// Returns true if a texture with deferred uploads is bound differently. Draws before the frame binds others may need
// it.
bool othersWait(const Textures& now, const Textures& begins) {
    for (size_t unit = 0; unit < now.size(); ++unit)
        for (size_t i = 0; i < kTextureTargets; ++i)
            if (now[unit][i] != begins[unit][i] && now[unit][i] != nullptr && now[unit][i]->waits()) return true;
    return false;
}

// Returns true if a frame that begins with these bindings can match the template.
bool mayBegin(const FrameMatcher& same, const Bindings& now) {
    return now.equalButTextures(same.begins) && leadsTo(now.units, same.begins.units, same.ends.units) &&
           !othersWait(now.units, same.begins.units);
}

bool nothingSaved(const Context& c) { return c.attribs.empty() && c.clientAttribs.empty(); }

} // namespace

// Returns true if the next records of this stream can match the template.
bool CommandFilter::mayRepeat(const Stream& stream) const {
    const Context* const c = stream.context;
    return !dropsRedundant_ && c != nullptr && c->group.use_count() == 1 && !c->group->untracked && stream.list == 0;
}

// Returns true if the template is still valid for this context.
bool CommandFilter::repeats(const Stream& stream) const {
    const FrameMatcher& same = stream.same;
    if (!mayRepeat(stream) || stream.context != same.context) return false;
    const Group& group = *stream.context->group;
    return group.deferredChanges == same.deferredChanges && group.objectChanges == same.objectChanges;
}

// Skips records that match the template.
void CommandFilter::passSame(Stream& stream, wire::RecordWalk& walk, const Packet& packet) {
    size_t at = walk.at();
    RecordOffsets walked;
    const FrameTemplate::Stop stop = stream.same.frameTemplate.pass(packet, at, walked);
    walk.goTo(at, walked);
    counts_.alikeRecords += walked.records;
    if (stop == FrameTemplate::Stop::Differs || stop == FrameTemplate::Stop::End) leaveSame(stream);
}

// Handles a record that passSame() did not skip.
void CommandFilter::seeSame(Stream& stream, const RecordView& r, const CommandKind& kind) {
    if (!stream.same.frameTemplate.passSeen(r.opcode)) return leaveSame(stream);
    if (kind.frame != FrameRole::Seen) trackSame(stream);
}

void CommandFilter::trackSameTo(Stream& stream, size_t to) {
    Output nothing(stream.id, {}, otherScratch_, take_);
    stream.same.frameTemplate.track(to, [&](std::span<const std::byte> bytes) {
        wire::RecordWalk one(bytes);
        RecordView r;
        if (one.next(r)) record(stream, nothing, r, kinds_[r.opcode], 0, bytes);
    });
    nothing.finish();
}

// Follows all skipped records, from the mark on if it was passed.
void CommandFilter::trackSame(Stream& stream) {
    FrameMatcher& same = stream.same;
    const size_t passed = same.frameTemplate.passed();
    FrameMatcher::Mark& mark = same.mark;
    if (mark.tracked > same.frameTemplate.tracked() && mark.tracked <= passed &&
        leadsTo(same.began, mark.began, mark.bound.units)) {
        stream.context->takeOver(mark.bound);
        stream.inPrimitive = mark.inPrimitive;
        same.frameTemplate.trackFrom(mark.tracked);
    }
    // The next frame may differ a little earlier.
    const size_t marked = passed - passed / 16;
    if (marked >= same.frameTemplate.tracked() + kWorthAMark &&
        (mark.tracked == 0 || same.frames - mark.frame >= kMarkFrames)) {
        trackSameTo(stream, marked);
        if (nothingSaved(*stream.context))
            mark = {marked, same.frames, same.began, *stream.context, stream.inPrimitive};
    }
    trackSameTo(stream, passed);
}

// Returns to following each record.
void CommandFilter::leaveSame(Stream& stream) {
    FrameMatcher& same = stream.same;
    if (same.now != FrameMatcher::Now::Matching) return;
    trackSame(stream);
    same.now = FrameMatcher::Now::Apart;
    if (stream.context != nullptr) stream.context->needs = true; // skipped draws were not examined
}

void CommandFilter::leaveSameOf(const Group& group) {
    for (auto& [id, stream] : streams_)
        if (stream.context != nullptr && stream.context->group.get() == &group) leaveSame(stream);
}

// Called after an examined record.
void CommandFilter::keepSame(Stream& stream, const RecordView& r, const Packet& packet) {
    if (stream.same.now == FrameMatcher::Now::Matching && !repeats(stream)) leaveSame(stream);
    if (r.opcode == wire::kOpSwap || r.opcode == wire::kOpFrontPicture)
        endSame(stream, packet.first(r.offset + r.sizeBytes));
}

// Appends records to the template that is being built. They have been tracked.
void CommandFilter::keepRecords(Stream& stream, const Packet& packet) {
    FrameMatcher& same = stream.same;
    wire::RecordWalk walk(packet.subspan(same.templateBytes));
    RecordView r;
    bool keeps = repeats(stream);
    while (keeps && walk.next(r)) {
        const CommandKind& kind = kinds_[r.opcode];
        const bool takesValue = same.inValue && kind.about != CommandClass::Blob;
        same.inValue = kind.about == CommandClass::Blob;
        const FrameRole role = kind.frame == FrameRole::Ends || (r.opcode == wire::kOpMakeCurrent &&
                                                                 wire::argumentWord(r, 0) != stream.context->id)
                                   ? FrameRole::Ends
                               : takesValue ? FrameRole::SeenBound
                                            : kind.frame;
        const Same how = role == FrameRole::Draws ? Same::Head : role == FrameRole::Binds ? Same::All : Same::Seen;
        keeps = role != FrameRole::Ends &&
                same.frameTemplate.add(how, packet.subspan(same.templateBytes + r.offset, r.sizeBytes));
    }
    same.templateBytes = packet.size();
    if (keeps) return;
    same.now = FrameMatcher::Now::Apart;
    same.frameTemplate.clear();
}

// The frame ends with this packet.
void CommandFilter::endSame(Stream& stream, const Packet& packet) {
    using Now = FrameMatcher::Now;
    FrameMatcher& same = stream.same;
    if (same.now == Now::Recording) keepRecords(stream, packet);
    if (same.now == Now::Matching && !same.frameTemplate.atEnd()) leaveSame(stream);
    const bool returns = same.begins.units == same.ends.units;
    if (same.now == Now::Matching && (same.frameTemplate.tracked() > 0 || !returns)) {
        stream.context->takeOver(same.ends);
        stream.context->needs = true;
        stream.inPrimitive = false;
    }
    if (!mayRepeat(stream) || stream.inPrimitive || !nothingSaved(*stream.context) ||
        (same.now != Now::Matching && !fewEnough(*stream.context))) {
        same.now = Now::Apart;
        return;
    }
    const Bindings& bound = *stream.context;
    Group& group = *stream.context->group;
    if (same.now == Now::Recording) {
        same.ends = bound;
        if (!bound.equalButTextures(same.begins)) same.frameTemplate.clear();
    }
    const double share = same.frameTemplate.share();
    ++same.frames;
    same.shares += share;
    if (group.deferred.empty()) same.deferredChanges = group.deferredChanges; // no draw can need anything deferred
    const bool isLike = same.now == Now::Matching ||
                        (!same.frameTemplate.empty() && repeats(stream) && (share >= kLike || same.frames < same.wait));
    const bool goesOn = isLike && mayBegin(same, bound);
    same.now = goesOn ? Now::Matching : Now::Apart;
    if (goesOn) same.began = bound.units;
    same.frameTemplate.begin();
    if (goesOn || same.frames < same.wait) return;
    // Builds a new template; at growing intervals if templates did not match before.
    same.wait =
        same.shares >= kUnlike * same.frames ? FrameMatcher::kFirst : std::min(same.wait * 2, FrameMatcher::kMax);
    same.now = Now::Recording;
    same.templateBytes = packet.size();
    same.inValue = false;
    same.frameTemplate.clear();
    same.mark.tracked = 0;
    same.context = stream.context;
    same.deferredChanges = group.deferredChanges;
    same.objectChanges = group.objectChanges;
    same.begins = bound;
    same.frames = 0;
    same.shares = 0;
}

} // namespace mural::filter
