// Objects: names, references, bindings.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>

#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/binding_slots.hpp"

namespace mural::snapshot {
namespace {

constexpr uint64_t idOf(ObjectType type, uint32_t name) { return uint64_t{static_cast<uint8_t>(type)} << 32 | name; }

// Returns true for types that belong to a context: GL does not share container objects and queries.
bool isOwn(ObjectType type) {
    return type == ObjectType::Framebuffer || type == ObjectType::VertexArray || type == ObjectType::Query ||
           type == ObjectType::Pipeline || type == ObjectType::Feedback;
}

} // namespace

Objects& GlStateTracker::tableOf(At& at, ObjectType type) {
    return isOwn(type) ? at.context->own : at.context->group->objects;
}

Object* GlStateTracker::find(At& at, ObjectType type, uint32_t name) {
    if (at.context == nullptr) return nullptr;
    Objects& table = tableOf(at, type);
    const auto found = table.find(idOf(type, name));
    return found == table.end() ? nullptr : found->second.get();
}

// Creates an object, replacing any of that name.
Object* GlStateTracker::make(At& at, ObjectType type, uint32_t name) {
    if (Object* const old = find(at, type, name)) { // GL never returns a name twice: a deletion was missed
        old->opaque = true;
        at.effect.write(old->key);
        return old;
    }
    auto object = std::make_unique<Object>();
    object->type = type;
    object->name = name;
    // A deleted but retained object of that name keeps the plain key.
    Group& group = *at.context->group;
    const bool taken =
        std::ranges::any_of(group.gone, [&](const auto& o) { return o->type == type && o->name == name; });
    object->key = part(isOwn(type) ? at.context->key : group.key, Part::Object, idOf(type, name),
                       taken ? ++group.incarnations : 0);
    object->made = true;
    at.effect.kill(object->key);
    if (type == ObjectType::Texture || type == ObjectType::Renderbuffer) {
        object->images = part(group.images, Part::Object, idOf(type, name), taken ? group.incarnations : 0);
        at.effect.kill(object->images);
    }
    // Results of queries: no draw depends on them.
    if (type == ObjectType::Query)
        object->images =
            part(part(at.client.results, Part::Context, at.thread.context), Part::Object, idOf(type, name));
    auto& place = tableOf(at, type)[idOf(type, name)];
    place = std::move(object);
    return place.get();
}

// Some objects are created by the first use of their name.
Object* GlStateTracker::findOrMake(At& at, ObjectType type, uint32_t name) {
    if (Object* const object = find(at, type, name)) return object;
    Object* const object = make(at, type, name);
    object->made = false;
    object->anyUnit = true; // its origin is unknown
    return object;
}

void GlStateTracker::retain(At& at, Object*& slot, Object* next) {
    if (slot == next) return;
    if (next != nullptr) ++next->refCount;
    Object* const old = std::exchange(slot, next);
    if (old != nullptr) release(at, old);
}

void GlStateTracker::release(At& at, Object* object) {
    if (object->refCount > 0) --object->refCount;
    if (object->deleted && object->refCount == 0) erase(at, object);
}

// Removes an object that can no longer be used.
void GlStateTracker::erase(At& at, Object* object) {
    if (!object->opaque && !at.context->group->trackingDisabled)
        for (const Key key : {object->key, object->images})
            if (key != kNoKey) at.effect.add(key, Mode::Forget);
    for (auto& [slot, retained] : object->references) retain(at, retained, nullptr);
    for (auto& [point, attachment] : object->attachments) retain(at, attachment.object, nullptr);
    auto& gone = at.context->group->gone;
    std::erase_if(gone, [object](const auto& o) { return o.get() == object; });
}

// The command refers to the object: its creation is needed, and its deletion too.
void GlStateTracker::use(At& at, Object* object) {
    const Key name = part(object->key, Part::Name);
    if (!object->made) at.effect.write(name);
    object->made = true;
    at.effect.read(name);
}

void GlStateTracker::objects(At& at, const EffectRule& rule, const RecordView& r) {
    std::vector<uint32_t> names;
    switch (rule.kind) {
    case EffectKind::Gen: {
        if (!namesAt(r, rule.nameWord, names)) return unknown(at, true);
        for (const uint32_t name : names) {
            if (name == 0) continue;
            Object* const object = make(at, rule.type, name);
            if (r.opcode == op::glCreateTextures) object->target = argumentWord(r, 0);
        }
        return;
    }
    case EffectKind::Create: {
        const uint32_t name = argumentWord(r, rule.resultWord);
        if (name != 0) make(at, rule.type, name)->anyUnit = r.opcode == op::glCreateShader; // until its source is known
        return;
    }
    case EffectKind::SyncMake:
        at.effect.kill(
            part(at.context->group->key, Part::Object, idOf(ObjectType::Sync, 0), argumentWide(r, rule.resultWord)));
        return;
    case EffectKind::SyncDelete: {
        const Key sync = part(at.context->group->key, Part::Object, idOf(ObjectType::Sync, 0), argumentWide(r, 0));
        at.effect.add(sync, Mode::Forget);
        at.effect.add(sync, Mode::Close);
        return;
    }
    default: return deleteNames(at, rule.type, r);
    }
}

void GlStateTracker::deleteNames(At& at, ObjectType type, const RecordView& r) {
    std::vector<uint32_t> names;
    if (!namesAt(r, 1, names)) return unknown(at, true);
    // Deletion unbinds the object where it is currently bound, and only there.
    for (const Slot slot : {Slot::DrawFramebuffer, Slot::ReadFramebuffer, Slot::VertexArray})
        at.effect.read(part(at.context->cells, Part::Binding, slotOf(slot)));
    if (!at.context->attribs.empty()) at.context->attribs.back().texturesTouched = true;
    for (const auto* stack : {&at.context->attribs, &at.context->clientAttribs}) // they restore bindings
        for (const SavedAttribs& level : *stack) at.effect.read(level.key);
    for (const uint32_t name : names) {
        if (name == 0) continue;
        // It may belong to another context: extensions share objects that core GL does not.
        if (isOwn(type) && find(at, type, name) == nullptr) at.effect.always = true;
        deleteOne(at, type, name);
    }
}

void GlStateTracker::deleteOne(At& at, ObjectType type, uint32_t name) {
    Objects& table = tableOf(at, type);
    const auto found = table.find(idOf(type, name));
    if (found == table.end()) return;
    Object* const object = found->second.get();
    for (const Key key : {object->key, object->images})
        if (key != kNoKey) at.effect.add(key, Mode::Close);
    object->deleted = true;
    at.context->group->gone.push_back(std::move(found->second));
    table.erase(found);
    ++object->refCount; // keeps the object alive while its bindings are removed
    if (type != ObjectType::Program && type != ObjectType::Pipeline) {
        for (auto& [slot, there] : at.context->bindings)
            if (there == object) retain(at, there, nullptr);
        // Only current bindings are released.
        for (const Slot slot : {Slot::DrawFramebuffer, Slot::ReadFramebuffer})
            if (Object* const target = bound(at, slotOf(slot)))
                for (auto& [point, attachment] : target->attachments)
                    if (attachment.object == object) retain(at, attachment.object, nullptr);
        Object* const current = bound(at, slotOf(Slot::VertexArray));
        if (Object* const array = current != nullptr ? current : find(at, ObjectType::VertexArray, 0))
            for (auto& [slot, retained] : array->references)
                if (retained == object) retain(at, retained, nullptr);
    }
    release(at, object);
}

// ---- bindings

Object* GlStateTracker::bound(At& at, uint64_t slot) const {
    const auto found = at.context->bindings.find(slot);
    return found == at.context->bindings.end() ? nullptr : found->second;
}

void GlStateTracker::bindSlot(At& at, uint64_t slot, Key key, uint32_t attribBits, Object* object) {
    if (object != nullptr) use(at, object);
    set(at, key, attribBits);
    retain(at, at.context->bindings[slot], object);
}

void GlStateTracker::bindPlain(At& at, const EffectRule& rule, uint64_t slot, uint32_t name) {
    Object* const object = name == 0 ? nullptr : findOrMake(at, rule.type, name);
    bindSlot(at, slot, part(at.context->cells, Part::Binding, slot), rule.attribBits, object);
}

void GlStateTracker::bind(At& at, const EffectRule& rule, const RecordView& r) {
    const uint32_t first = argumentWord(r, 0), name = argumentWord(r, rule.nameWord);
    switch (rule.type) {
    case ObjectType::Texture:
        if (hasTrait(r.opcode, Trait::ImageBinding)) return bindPlain(at, rule, slotOf(Slot::Image, 0, first), name);
        return bindTexture(at, rule, first, name);
    case ObjectType::Buffer:
        if (rule.kind == EffectKind::Bind) return bindBuffer(at, rule, first, name);
        if (first == GL_TRANSFORM_FEEDBACK_BUFFER && bound(at, slotOf(Slot::Feedback)) != nullptr)
            return unknown(at, false);
        bindPlain(at, rule, slotOf(Slot::IndexedBuffer, first, argumentWord(r, 1)), name);
        return bindPlain(at, rule, slotOf(Slot::Buffer, first), name); // the generic binding too
    case ObjectType::VertexArray: return bindVertexArray(at, rule, name);
    case ObjectType::Framebuffer:
        if (first != GL_READ_FRAMEBUFFER) bindPlain(at, rule, slotOf(Slot::DrawFramebuffer), name);
        if (first != GL_DRAW_FRAMEBUFFER) bindPlain(at, rule, slotOf(Slot::ReadFramebuffer), name);
        return;
    case ObjectType::Sampler: return bindPlain(at, rule, slotOf(Slot::Sampler, 0, first), name);
    case ObjectType::Program: return bindPlain(at, rule, slotOf(Slot::Program), name);
    case ObjectType::Pipeline: return bindPlain(at, rule, slotOf(Slot::Pipeline), name);
    case ObjectType::Feedback: return bindPlain(at, rule, slotOf(Slot::Feedback), name);
    case ObjectType::ArbProgram: return bindPlain(at, rule, slotOf(Slot::ArbProgram, first), name);
    case ObjectType::Renderbuffer: return bindPlain(at, rule, slotOf(Slot::Renderbuffer), name);
    default: return unknown(at, true); // no command binds other objects
    }
}

// place: the target of a Bind, which binds to the active unit; the unit of a BindIndexed.
void GlStateTracker::bindTexture(At& at, const EffectRule& rule, uint32_t place, uint32_t name) {
    ContextNames& c = *at.context;
    Object* const object = name == 0 ? nullptr : findOrMake(at, ObjectType::Texture, name);
    const bool toUnit = rule.kind == EffectKind::BindIndexed;
    if (toUnit && (object == nullptr || object->target == 0)) return unknown(at, true);
    if (!toUnit && object != nullptr && object->target == 0) object->target = place;
    const uint32_t unit = toUnit ? place : c.unit;
    const uint64_t slot = slotOf(Slot::Texture, toUnit ? object->target : place, unit);
    if (!toUnit) at.effect.read(part(c.cells, Part::ActiveUnit));
    bindSlot(at, slot, part(part(c.cells, Part::TextureUnit, unit), Part::Binding, slot), rule.attribBits, object);
}

void GlStateTracker::bindBuffer(At& at, const EffectRule& rule, uint32_t target, uint32_t name) {
    ContextNames& c = *at.context;
    const auto keyOf = [&](uint64_t slot) { return part(c.cells, Part::Binding, slot); };
    const uint64_t slot = slotOf(Slot::Buffer, target);
    if (target != GL_ELEMENT_ARRAY_BUFFER) {
        bindPlain(at, rule, slot, name);
        if (!c.clientAttribs.empty()) setClient(at, keyOf(slot));
        return;
    }
    // The element array binding belongs to the vertex array.
    const uint64_t arraySlot = slotOf(Slot::VertexArray);
    Object* const current = bound(at, arraySlot);
    Object* const array = findOrMake(at, ObjectType::VertexArray, current != nullptr ? current->name : 0);
    Object* const buffer = name == 0 ? nullptr : findOrMake(at, ObjectType::Buffer, name);
    if (buffer != nullptr) use(at, buffer);
    at.effect.read(keyOf(arraySlot));
    setClient(at, part(array->key, Part::Binding, slot));
    retain(at, array->references[slot], buffer);
    retain(at, c.bindings[slot], buffer);
}

void GlStateTracker::bindVertexArray(At& at, const EffectRule& rule, uint32_t name) {
    ContextNames& c = *at.context;
    const uint64_t slot = slotOf(Slot::VertexArray), indices = slotOf(Slot::Buffer, GL_ELEMENT_ARRAY_BUFFER);
    bindPlain(at, rule, slot, name);
    if (!c.clientAttribs.empty()) setClient(at, part(c.cells, Part::Binding, slot));
    Object* const array = find(at, ObjectType::VertexArray, name);
    const auto retained = array == nullptr ? decltype(array->references)::iterator{} : array->references.find(indices);
    retain(at, c.bindings[indices],
           array == nullptr || retained == array->references.end() ? nullptr : retained->second);
}

// ---- vertex arrays

// Marks the buffers that the command names. Bindings of this kind are not tracked.
void GlStateTracker::useUntracked(At& at, const EffectRule& rule, const RecordView& r, bool makes) {
    std::vector<uint32_t> names;
    if (rule.nameWord == kNoArgumentWord) return;
    if (rule.nameWord != rule.valueWord)
        names.push_back(argumentWord(r, rule.nameWord));
    else if (!namesAt(r, rule.nameWord, names))
        names.clear();
    for (const uint32_t name : names) {
        if (name == 0) continue;
        Object* const buffer = makes ? findOrMake(at, ObjectType::Buffer, name) : find(at, ObjectType::Buffer, name);
        if (buffer == nullptr) continue;
        use(at, buffer);
        buffer->opaque = true;
    }
}

void GlStateTracker::arrays(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    if (rule.kind == EffectKind::ArrayNamedSet) {
        Object* const array = findOrMake(at, ObjectType::VertexArray, argumentWord(r, 0));
        useUntracked(at, rule, r, false);
        use(at, array);
        return at.effect.kill(cell(at, array->key, r.opcode, rule, r));
    }
    const uint64_t arraySlot = slotOf(Slot::VertexArray), bufferSlot = slotOf(Slot::Buffer, GL_ARRAY_BUFFER);
    Object* const current = bound(at, arraySlot);
    Object* const array = current != nullptr ? current : findOrMake(at, ObjectType::VertexArray, 0);
    at.effect.read(part(c.cells, Part::Binding, arraySlot));
    if (array->name != 0) use(at, array);
    Key above = array->key;
    const bool ofCoordinates = r.opcode == op::glTexCoordPointer || rule.kind == EffectKind::ClientCap;
    if (ofCoordinates) {
        at.effect.read(part(c.cells, Part::ClientUnit));
        above = part(above, Part::TextureUnit, c.clientUnit);
    }
    if (rule.kind == EffectKind::ClientCap)
        return setClient(at, keys_.child(above, op::glEnableClientState, argumentWord(r, 0)));
    const bool numbered = rule.kind == EffectKind::ArraySet || hasTrait(r.opcode, Trait::ArrayIndex);
    const uint32_t index = numbered ? argumentWord(r, 0) : 0;
    if (rule.kind == EffectKind::ArraySet) {
        if (rule.nameWord != kNoArgumentWord) { // first, count, buffers, ...
            useUntracked(at, rule, r, true);
            return setClient(at, keys_.child(above, r.opcode, index, argumentWord(r, 1)));
        }
        // enabling and disabling set one cell
        const uint32_t kind = hasTrait(r.opcode, Trait::TurnsOff) ? uint32_t{op::glEnableVertexAttribArray} : r.opcode;
        return setClient(at, keys_.child(above, kind, index));
    }
    Object* buffer = bound(at, bufferSlot);
    if (rule.nameWord != kNoArgumentWord) {
        const uint32_t name = argumentWord(r, rule.nameWord);
        buffer = name == 0 ? nullptr : findOrMake(at, ObjectType::Buffer, name);
    } else {
        at.effect.read(part(c.cells, Part::Binding, bufferSlot));
    }
    if (buffer != nullptr) use(at, buffer);
    setClient(at, keys_.child(above, r.opcode, index));
    retain(at, array->references[uint64_t{r.opcode} << 32 | (ofCoordinates ? c.clientUnit << 16 : 0) | index], buffer);
}

} // namespace mural::snapshot
