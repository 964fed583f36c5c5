// Frames that bind what the one before did: nothing of them is followed.
//
// What a record does to what is bound depends on nothing but its bytes, what is bound, and which objects there are. A frame is kept
// (FrameLayout) that left bound what it had begun with, but for textures. While the next one has the same records, those that bind with all
// their bytes, it leaves that, too; where it has another one, those before it are followed at once. What waited all through the frame that
// was kept goes on waiting: the same draws need it no more than they did.
#include "gl_opcodes.hpp"
#include "holding/holder.hpp"
#include "streamcodec/wire.hpp"

namespace mural::holding {

namespace {

constexpr size_t kMostCompared = 1024; // vertex arrays, and what they have bound: they are compared, or copied, once for a frame
constexpr double kLike = 0.9, kUnlike = 0.5;
constexpr size_t kWorthAMark = 64;   // records that would be followed each time
constexpr uint32_t kMarkFrames = 16; // between two of them

bool fewEnough(const Bindings& b) {
    size_t count = b.units.size() * kTextureTargets + b.arrays.size();
    for (const auto& [name, array] : b.arrays) count += array.buffers.size();
    return count <= kMostCompared;
}

using Textures = std::vector<TextureUnit>;

// Whether a frame, or a part of one, that took `begins` to `after`, takes `now` to it, too: what it has changed it has bound itself.
bool leadsTo(const Textures& now, const Textures& begins, const Textures& after) {
    if (now == begins) return true;
    if (now.size() != begins.size() || now.size() != after.size()) return false;
    for (size_t unit = 0; unit < now.size(); ++unit)
        for (size_t i = 0; i < kTextureTargets; ++i)
            if (now[unit][i] != begins[unit][i] && begins[unit][i] == after[unit][i]) return false;
    return true;
}

// Of textures that are bound otherwise than they were. Draws in front of where the frame binds others may need it.
bool othersWait(const Textures& now, const Textures& begins) {
    for (size_t unit = 0; unit < now.size(); ++unit)
        for (size_t i = 0; i < kTextureTargets; ++i)
            if (now[unit][i] != begins[unit][i] && now[unit][i] != nullptr && now[unit][i]->waits()) return true;
    return false;
}

// Whether a frame may begin with that and be taken for the one that was kept.
bool mayBegin(const SameFrames& same, const Bindings& now) {
    return now.equalButTextures(same.begins) && leadsTo(now.units, same.begins.units, same.ends.units) && !othersWait(now.units, same.begins.units);
}

bool nothingSaved(const Context& c) { return c.attribs.empty() && c.clientAttribs.empty(); }

} // namespace

// Whether what this stream says next can be taken for what it said before.
bool Holder::mayRepeat(const Stream& stream) const {
    const Context* const c = stream.context;
    return !leavesOutSmall_ && c != nullptr && c->group.use_count() == 1 && !c->group->untracked && stream.list == 0;
}

// Whether it is still what the frame is about that was kept, or is.
bool Holder::repeats(const Stream& stream) const {
    const SameFrames& same = stream.same;
    if (!mayRepeat(stream) || stream.context != same.context) return false;
    const Group& group = *stream.context->group;
    return group.heldChanges == same.heldChanges && group.objectChanges == same.objectChanges;
}

// On over what is like the frame before.
void Holder::passSame(Stream& stream, recording::RecordWalk& walk, const Packet& packet) {
    size_t at = walk.at();
    Walked walked;
    const FrameLayout::Stop stop = stream.same.layout.pass(packet, at, walked);
    walk.goTo(at, walked);
    counts_.alikeRecords += walked.records;
    if (stop == FrameLayout::Stop::Differs || stop == FrameLayout::Stop::End) leaveSame(stream);
}

// A record that passSame() has not passed comes.
void Holder::seeSame(Stream& stream, const RecordView& r, const CommandKind& kind) {
    if (!stream.same.layout.passSeen(r.opcode)) return leaveSame(stream);
    if (kind.frame != FrameRole::Seen) followSame(stream);
}

void Holder::followSameTo(Stream& stream, size_t to) {
    Output nothing(stream.id, {}, otherScratch_, take_);
    stream.same.layout.follow(to, [&](std::span<const std::byte> bytes) {
        recording::RecordWalk one(bytes);
        RecordView r;
        if (one.next(r)) record(stream, nothing, r, kinds_[r.opcode], 0, bytes);
    });
    nothing.finish();
}

// All that was passed is followed: from the mark on, where that was passed.
void Holder::followSame(Stream& stream) {
    SameFrames& same = stream.same;
    const size_t passed = same.layout.passed();
    SameFrames::Mark& mark = same.mark;
    if (mark.followed > same.layout.followed() && mark.followed <= passed && leadsTo(same.began, mark.began, mark.bound.units)) {
        stream.context->takeOver(mark.bound);
        stream.inPrimitive = mark.inPrimitive;
        same.layout.followFrom(mark.followed);
    }
    // The next frame may have another record a little earlier than this one.
    const size_t marked = passed - passed / 16;
    if (marked >= same.layout.followed() + kWorthAMark && (mark.followed == 0 || same.frames - mark.frame >= kMarkFrames)) {
        followSameTo(stream, marked);
        if (nothingSaved(*stream.context)) mark = {marked, same.frames, same.began, *stream.context, stream.inPrimitive};
    }
    followSameTo(stream, passed);
}

// From here on each record is followed again.
void Holder::leaveSame(Stream& stream) {
    SameFrames& same = stream.same;
    if (same.now != SameFrames::Now::Following) return;
    followSame(stream);
    same.now = SameFrames::Now::Apart;
    if (stream.context != nullptr) stream.context->needs = true; // draws were not looked at
}

void Holder::leaveSameOf(const Group& group) {
    for (auto& [id, stream] : streams_)
        if (stream.context != nullptr && stream.context->group.get() == &group) leaveSame(stream);
}

// Behind a record that has been looked at.
void Holder::keepSame(Stream& stream, const RecordView& r, const Packet& packet) {
    if (stream.same.now == SameFrames::Now::Following && !repeats(stream)) leaveSame(stream);
    if (r.opcode == wire::kOpSwap || r.opcode == wire::kOpFrontPicture) endSame(stream, packet.first(r.offset + r.sizeBytes));
}

// Records of the frame that is kept, from where the last ones ended. They have been followed.
void Holder::keepRecords(Stream& stream, const Packet& packet) {
    SameFrames& same = stream.same;
    recording::RecordWalk walk(packet.subspan(same.keptBytes));
    RecordView r;
    bool keeps = repeats(stream);
    while (keeps && walk.next(r)) {
        const CommandKind& kind = kinds_[r.opcode];
        const bool takesValue = same.inValue && kind.about != CommandClass::Blob;
        same.inValue = kind.about == CommandClass::Blob;
        const FrameRole role = kind.frame == FrameRole::Ends || (r.opcode == wire::kOpMakeCurrent && recording::argumentWord(r, 0) != stream.context->id) ? FrameRole::Ends : takesValue ? FrameRole::SeenBound : kind.frame;
        const Same how = role == FrameRole::Draws ? Same::Head : role == FrameRole::Binds ? Same::All : Same::Seen;
        keeps = role != FrameRole::Ends && same.layout.add(how, packet.subspan(same.keptBytes + r.offset, r.sizeBytes));
    }
    same.keptBytes = packet.size();
    if (keeps) return;
    same.now = SameFrames::Now::Apart;
    same.layout.clear();
}

// The frame ends, with the packet.
void Holder::endSame(Stream& stream, const Packet& packet) {
    using Now = SameFrames::Now;
    SameFrames& same = stream.same;
    if (same.now == Now::Recording) keepRecords(stream, packet);
    if (same.now == Now::Following && !same.layout.atEnd()) leaveSame(stream);
    const bool returns = same.begins.units == same.ends.units;
    if (same.now == Now::Following && (same.layout.followed() > 0 || !returns)) {
        stream.context->takeOver(same.ends);
        stream.context->needs = true;
        stream.inPrimitive = false;
    }
    if (!mayRepeat(stream) || stream.inPrimitive || !nothingSaved(*stream.context) || (same.now != Now::Following && !fewEnough(*stream.context))) {
        same.now = Now::Apart;
        return;
    }
    const Bindings& bound = *stream.context;
    Group& group = *stream.context->group;
    if (same.now == Now::Recording) {
        same.ends = bound;
        if (!bound.equalButTextures(same.begins)) same.layout.clear();
    }
    const double share = same.layout.share();
    ++same.frames;
    same.shares += share;
    if (group.held.empty()) same.heldChanges = group.heldChanges; // nothing waits that a draw could need
    const bool isLike = same.now == Now::Following || (!same.layout.empty() && repeats(stream) && (share >= kLike || same.frames < same.wait));
    const bool goesOn = isLike && mayBegin(same, bound);
    same.now = goesOn ? Now::Following : Now::Apart;
    if (goesOn) same.began = bound.units;
    same.layout.begin();
    if (goesOn || same.frames < same.wait) return;
    // Kept anew; seldom, where that did not help before.
    same.wait = same.shares >= kUnlike * same.frames ? SameFrames::kFirst : std::min(same.wait * 2, SameFrames::kMost);
    same.now = Now::Recording;
    same.keptBytes = packet.size();
    same.inValue = false;
    same.layout.clear();
    same.mark.followed = 0;
    same.context = stream.context;
    same.heldChanges = group.heldChanges;
    same.objectChanges = group.objectChanges;
    same.begins = bound;
    same.frames = 0;
    same.shares = 0;
}

} // namespace mural::holding
