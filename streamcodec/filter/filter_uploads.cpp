// Uploads: the decision to defer them, and later commands on objects with deferred uploads.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <utility>
#include <vector>

#include "streamcodec/command_traits.hpp"
#include "streamcodec/filter/command_filter.hpp"
#include "streamcodec/effect_rules.hpp"
#include "streamcodec/wire/record_blobs.hpp"
#include "streamcodec/wire/record.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::filter {

using wire::argumentWord;

namespace {

// Smaller uploads cost more to defer than to send.
constexpr size_t kMinBytes = 512;
constexpr size_t kMaxItems = 4096;     // per object
constexpr size_t kMaxLocations = 1024; // of uniforms

// Returns true if no uniform type can reject these values. Samplers accept unit numbers only, so a larger value may be
// rejected where its predecessor was not.
bool refusedByNone(const wire::RecordView& r, size_t firstValueWord) {
    constexpr uint32_t kUnits = 16; // minimum that every GL supports
    if (!hasTrait(r.opcode, Trait::SamplerUniform)) return true;
    for (size_t word = firstValueWord; word < r.arguments.size() / 4; ++word)
        if (argumentWord(r, word) >= kUnits) return false;
    return true;
}

// Returns true if the record sets one whole uniform at that location, with the value inline.
bool isOneUniform(const wire::RecordView& r, const CommandKind& kind, size_t locationWord) {
    const bool counted = kind.valueWord != kNoValue;
    return argumentWord(r, locationWord) < kMaxLocations && r.sizeBytes <= StateCache<kUniformWords>::kMaxBytes &&
           (!counted || argumentWord(r, locationWord + 1) == 1);
}

} // namespace

// Returns the object of an upload, or of a command of class Object.
Object* CommandFilter::objectOf(At& at) {
    const uint32_t first = argumentWord(at.r, 0);
    if (at.r.opcode == wire::kOpBufferBytes) return find(at.group, Kind::Buffer, first);
    if (at.kind.effect == EffectKind::Uniform) return at.context.programSure ? at.context.program : nullptr;
    const EffectRule& rule = effectRuleOf(at.r.opcode);
    switch (rule.kind) {
    case EffectKind::Nothing: // invalidations of buffers
    case EffectKind::BufferData:
    case EffectKind::BufferSubData:
        return rule.type == ObjectType::Buffer ? find(at.group, Kind::Buffer, first) : bufferAt(at.context, first);
    case EffectKind::ShaderDelete:
    case EffectKind::ProgramAttach:
    case EffectKind::ProgramDetach:
    case EffectKind::ProgramSet:
    case EffectKind::ProgramLink:
    case EffectKind::ProgramUniform: return find(at.group, Kind::Program, first);
    default: return rule.type == ObjectType::Texture ? find(at.group, Kind::Texture, first) : textureAt(at, first);
    }
}

void CommandFilter::upload(At& at) {
    Object* const object = objectOf(at);
    const EffectKind effect = at.kind.effect;
    if (object == nullptr || object->open) return; // never deferred, contents unknown
    if (at.kind.small && !dropsRedundant_) return;
    const bool uniform = effect == EffectKind::Uniform;
    if (uniform) {
        if (at.stream.values == 0 && isOneUniform(at.r, at.kind, 0)) return oneUniform(at, *object, 0);
        // Elements of an array may be any of these.
        const bool certain = refusedByNone(at.r, at.kind.valueWord + size_t{1});
        if (!certain || object->uniforms.waiting()) releaseOne(at, *object);
        object->uniforms.forgetAll();
        if (!certain) return;
    }
    const uint64_t blobBytes = at.stream.values == 1 && wire::blobsTakenBy(at.r) == 1 ? at.stream.firstValueBytes : 0;
    const size_t sizeBytes = at.r.sizeBytes + at.stream.valueBytes;
    const bool small = sizeBytes < kMinBytes && !uniform;
    if (small && object->queue.empty() && object->known.empty()) return;
    if (uniform && object->queue.empty() && !object->deferral.tries()) return;
    const auto u = uploadOf(at.r, blobBytes);
    const bool first = !std::exchange(object->filled, true);
    // waiting for its blob would be in vain
    const bool inVain = (object->deferral.vain() || at.group.soonUsed.vain()) && (object->comparing.vain() || first);
    // For a texture addressed by name, the cube face is one of the arguments.
    const bool anyFace = effectRuleOf(at.r.opcode).type == ObjectType::Texture && object->target == GL_TEXTURE_CUBE_MAP;
    const bool fromBuffer = object->kind == Kind::Texture && bufferAt(at.context, GL_PIXEL_UNPACK_BUFFER) != nullptr;
    if (!u || at.stream.passing || fromBuffer || anyFace || (at.stream.values > 0 && blobBytes == 0)) {
        releaseOne(at, *object);
        object->known.clear();
        if (at.stream.passing && !inVain) at.stream.waiting.won();
        return;
    }
    // Test whether it changes the contents.
    const bool compares = u->given && !small && !uniform && object->comparing.tries();
    if (compares) {
        const Object::Comparison comparison = object->compare(*u, first, [&] { return sumOfValue(at, *u); });
        if (comparison == Object::Comparison::Same) {
            object->comparing.won();
            at.stream.waiting.won();
            countLeftOut(1 + at.stream.pendingRecords,
                         at.r.sizeBytes + (at.r.offset - at.from) + at.stream.pending.size());
            pendingBytes_ -= at.stream.pending.size();
            std::vector<std::byte>().swap(at.stream.pending);
            return at.output.drop(at.from, at.r.offset + at.r.sizeBytes);
        }
        if (comparison == Object::Comparison::Changed) object->comparing.lost();
    } else {
        object->forgets(*u);
    }
    const Object::Replaced gone = object->replaces(*u);
    countLeftOut(gone.records, gone.sizeBytes);
    counts_.deferredBytes -= gone.sizeBytes;
    if (object->queue.empty() && gone.records == 0 &&
        (small || !u->given || u->kind == UploadKind::Storage || (!uniform && !deferrable(at.group, *object)))) {
        if (at.stream.values > 0) inVain ? at.stream.waiting.lost() : at.stream.waiting.won();
        return;
    }
    deferUpload(at, *object, &*u, u->kind == UploadKind::Storage);
}

// A uniform that is not an array is deferred by location, so finding its predecessor needs no search.
void CommandFilter::oneUniform(At& at, Object& program, size_t locationWord) {
    const size_t location = argumentWord(at.r, locationWord);
    const auto record = at.packet.subspan(at.r.offset, at.r.sizeBytes);
    const bool certain =
        refusedByNone(at.r, at.kind.valueWord == kNoValue ? locationWord + 1 : at.kind.valueWord + size_t{1});
    // Another thread may set it in an unknown order, or the program to restore after a flush is unknown.
    if (at.context.group.use_count() > 1 || !at.context.programSure) {
        releaseOne(at, program);
        return program.uniforms.forgetAll();
    }
    if (!certain || program.uniforms.otherWaits(location, record)) {
        releaseOne(at, program);
        return program.uniforms.forget(location);
    }
    const bool deferrable = program.waits() || program.deferral.tries();
    if (!dropsRedundant_ && !deferrable) return program.uniforms.forget(location);
    const SetResult outcome = program.uniforms.set(location, record, deferrable);
    countFate(outcome, at.r.sizeBytes);
    if (outcome.fate == Disposition::Goes) return;
    program.gained = program.gained || outcome.gone > 0;
    at.output.drop(at.from, at.r.offset + at.r.sizeBytes);
    if (outcome.fate == Disposition::Waits) return waitsFor(at, program);
    if (!program.waits()) emptyQueue(at.group, program);
}

// Defers the record with the pieces of its blob.
void CommandFilter::deferUpload(At& at, Object& object, const Upload* upload, bool barrier) {
    Item item;
    const auto here = at.packet.subspan(at.from, at.r.offset + at.r.sizeBytes - at.from);
    pendingBytes_ -= at.stream.pending.size();
    item.bytes = std::move(at.stream.pending);
    at.stream.pending.clear();
    item.recordAt = static_cast<uint32_t>(item.bytes.size() + at.r.offset - at.from);
    item.bytes.insert(item.bytes.end(), here.begin(), here.end());
    item.records = 1 + at.stream.pendingRecords;
    const EffectRule& rule = effectRuleOf(at.r.opcode);
    const bool named =
        at.r.opcode == wire::kOpBufferBytes || rule.type == ObjectType::Texture || rule.type == ObjectType::Buffer;
    item.target = named ? 0 : 1;
    item.barrier = barrier;
    if (upload != nullptr) {
        item.isUpload = true;
        item.kind = upload->kind;
        item.place = upload->place;
        item.shape = upload->shape;
    }
    at.output.drop(at.from, at.r.offset + at.r.sizeBytes);
    counts_.deferredRecords += item.records;
    counts_.deferredBytes += item.bytes.size();
    object.deferredBytes += item.bytes.size();
    object.queue.push_back(std::move(item));
    waitsFor(at, object);
}

// Registers an object with its first deferred command. It is flushed when needed, or when the limit is reached.
void CommandFilter::waitsFor(At& at, Object& object) {
    Group& group = at.group;
    ++group.deferredChanges;
    if (std::ranges::find(group.deferred, &object) == group.deferred.end()) {
        group.deferred.push_back(&object);
        object.deferredSince = group.frame;
    }
    group.deferringContext = &at.context;
    group.deferringStream = at.stream.id;
    at.context.needs = true;
    const size_t behind = at.r.offset + at.r.sizeBytes;
    if (object.queue.size() >= kMaxItems) {
        Object* const one = &object;
        release(at.stream, at.output, behind, std::span(&one, 1));
    }
    makeRoom(at.stream, at.output, behind, 0);
}

// Handles a command on an object after its uploads.
void CommandFilter::objectCommand(At& at) {
    const EffectRule& rule = effectRuleOf(at.r.opcode);
    if (rule.kind == EffectKind::ProgramLink || rule.kind == EffectKind::ProgramSet ||
        rule.kind == EffectKind::ProgramUniform || rule.kind == EffectKind::ProgramAttach ||
        rule.kind == EffectKind::ProgramDetach || rule.kind == EffectKind::ShaderDelete) {
        Object* const program = objectOf(at);
        if (program == nullptr || (at.kind.small && !dropsRedundant_)) return;
        if (rule.kind == EffectKind::ProgramUniform && !program->open && at.stream.values == 0 &&
            isOneUniform(at.r, at.kind, 1))
            return oneUniform(at, *program, 1);
        releaseOne(at, *program);
        program->forget();
        if (rule.kind == EffectKind::ProgramLink) program->target = 0; // until the link is known to have succeeded
        return;
    }
    Object* const object = objectOf(at);
    if (object == nullptr) return;
    const bool parameter = rule.kind == EffectKind::TexParameter || rule.kind == EffectKind::NamedSet;
    // uploads have a side effect from now on
    if (parameter && argumentWord(at.r, 1) == GL_GENERATE_MIPMAP) return openUp(at, object);
    const bool mipmaps = rule.kind == EffectKind::TexMipmaps;
    if (mipmaps) std::erase_if(object->known, [](const Object::Known& k) { return k.place.level != 0; });
    if (!parameter && !mipmaps) { // a copy, or an invalidation
        releaseOne(at, *object);
        return object->known.clear();
    }
    if (object->queue.empty()) return;
    if (at.stream.values > 0) return releaseOne(at, *object);
    deferUpload(at, *object, nullptr, mipmaps);
}

Sum CommandFilter::sumOfValue(At& at, const Upload& upload) {
    Summing sum;
    if (at.stream.values == 0) {
        sum.add(upload.inlineValue);
        return sum.sum();
    }
    // independent of the division into pieces
    for (const auto pieces :
         {std::span<const std::byte>(at.stream.pending), at.packet.subspan(at.from, at.r.offset - at.from)}) {
        wire::RecordWalk walk(pieces);
        RecordView piece;
        while (walk.next(piece))
            if (piece.opcode == wire::kOpBlobData && piece.arguments.size() > 4)
                sum.add(
                    piece.arguments.subspan(4, std::min<size_t>(argumentWord(piece, 0), piece.arguments.size() - 4)));
    }
    return sum.sum();
}

} // namespace mural::filter
