// Objects: names, holders, bindings.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>

#include "gl_opcodes.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/binding_slots.hpp"

namespace mural::trace {
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
    // A deleted but held object of that name keeps the plain key.
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
    if (next != nullptr) ++next->holders;
    Object* const old = std::exchange(slot, next);
    if (old != nullptr) release(at, old);
}

void GlStateTracker::release(At& at, Object* object) {
    if (object->holders > 0) --object->holders;
    if (object->deleted && object->holders == 0) erase(at, object);
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

void GlStateTracker::objects(At& at, const Rule& rule, const RecordView& r) {
    std::vector<uint32_t> names;
    switch (rule.family) {
    case Family::Gen: {
        const size_t word = r.opcode == op::glCreateTextures || r.opcode == op::glCreateQueries ? 2 : 1;
        if (!namesAt(r, word, names)) return unknown(at, true);
        for (const uint32_t name : names) {
            if (name == 0) continue;
            Object* const object = make(at, rule.type, name);
            if (r.opcode == op::glCreateTextures) object->target = argumentWord(r, 0);
        }
        return;
    }
    case Family::Create: {
        const uint32_t name = argumentWord(r, r.opcode == op::glCreateShader ? 1 : 0);
        if (name != 0) make(at, rule.type, name)->anyUnit = r.opcode == op::glCreateShader; // until its source is known
        return;
    }
    case Family::SyncMake: // condition, flags, result
        at.effect.kill(part(at.context->group->key, Part::Object, idOf(ObjectType::Sync, 0), argumentWide(r, 2)));
        return;
    case Family::SyncDelete: {
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
    ++object->holders; // keeps the object alive while its bindings are removed
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

void GlStateTracker::bind(At& at, const Rule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const uint32_t first = argumentWord(r, 0), second = argumentWord(r, 1);
    const auto keyOf = [&](uint64_t slot) { return part(c.cells, Part::Binding, slot); };
    const auto objectOf = [&](uint32_t name) { return name == 0 ? nullptr : findOrMake(at, rule.type, name); };
    const auto simple = [&](uint64_t slot, uint32_t name) {
        bindSlot(at, slot, keyOf(slot), rule.attribBits, objectOf(name));
    };
    switch (r.opcode) {
    case op::glBindTexture: {
        Object* const object = objectOf(second);
        if (object != nullptr && object->target == 0) object->target = first;
        const uint64_t slot = slotOf(Slot::Texture, first, c.unit);
        at.effect.read(part(c.cells, Part::ActiveUnit));
        return bindSlot(at, slot, part(part(c.cells, Part::TextureUnit, c.unit), Part::Binding, slot), rule.attribBits,
                        object);
    }
    case op::glBindTextureUnit: {
        Object* const object = objectOf(second);
        const Key unit = part(c.cells, Part::TextureUnit, first);
        if (object == nullptr || object->target == 0) return unknown(at, true);
        const uint64_t slot = slotOf(Slot::Texture, object->target, first);
        return bindSlot(at, slot, part(unit, Part::Binding, slot), rule.attribBits, object);
    }
    case op::glBindBuffer: {
        const uint64_t slot = slotOf(Slot::Buffer, first);
        if (first != GL_ELEMENT_ARRAY_BUFFER) {
            simple(slot, second);
            if (!c.clientAttribs.empty()) setClient(at, keyOf(slot));
            return;
        }
        // The element array binding belongs to the vertex array.
        Object* const array =
            findOrMake(at, ObjectType::VertexArray,
                       bound(at, slotOf(Slot::VertexArray)) ? bound(at, slotOf(Slot::VertexArray))->name : 0);
        Object* const buffer = objectOf(second);
        if (buffer != nullptr) use(at, buffer);
        at.effect.read(keyOf(slotOf(Slot::VertexArray)));
        setClient(at, part(array->key, Part::Binding, slot));
        retain(at, array->references[slot], buffer);
        return retain(at, c.bindings[slot], buffer);
    }
    case op::glBindBufferBase:
    case op::glBindBufferRange: {
        const uint32_t name = argumentWord(r, 2);
        if (first == GL_TRANSFORM_FEEDBACK_BUFFER && bound(at, slotOf(Slot::Feedback)) != nullptr)
            return unknown(at, false);
        simple(slotOf(Slot::IndexedBuffer, first, second), name);
        return simple(slotOf(Slot::Buffer, first), name); // the generic binding too
    }
    case op::glBindVertexArray: {
        simple(slotOf(Slot::VertexArray), first);
        if (!c.clientAttribs.empty()) setClient(at, keyOf(slotOf(Slot::VertexArray)));
        Object* const array = find(at, ObjectType::VertexArray, first);
        const uint64_t indices = slotOf(Slot::Buffer, GL_ELEMENT_ARRAY_BUFFER);
        const auto retained =
            array == nullptr ? decltype(array->references)::iterator{} : array->references.find(indices);
        return retain(at, c.bindings[indices],
                      array == nullptr || retained == array->references.end() ? nullptr : retained->second);
    }
    case op::glBindSampler: return simple(slotOf(Slot::Sampler, 0, first), second);
    case op::glBindImageTexture: return simple(slotOf(Slot::Image, 0, first), second);
    case op::glUseProgram: return simple(slotOf(Slot::Program), first);
    case op::glBindProgramPipeline: return simple(slotOf(Slot::Pipeline), first);
    case op::glBindTransformFeedback: return simple(slotOf(Slot::Feedback), second);
    case op::glBindProgramARB: return simple(slotOf(Slot::ArbProgram, first), second);
    case op::glBindFramebuffer:
    case op::glBindFramebufferEXT:
    case op::glBindFramebufferOES:
        if (first != GL_READ_FRAMEBUFFER) simple(slotOf(Slot::DrawFramebuffer), second);
        if (first != GL_DRAW_FRAMEBUFFER) simple(slotOf(Slot::ReadFramebuffer), second);
        return;
    default: return simple(slotOf(Slot::Renderbuffer), second); // glBindRenderbuffer and similar
    }
}

// ---- vertex arrays

void GlStateTracker::arrays(At& at, const Rule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    if (rule.family == Family::ArrayNamedSet) {
        Object* const array = findOrMake(at, ObjectType::VertexArray, argumentWord(r, 0));
        const uint32_t name = r.opcode == op::glVertexArrayElementBuffer  ? argumentWord(r, 1)
                              : r.opcode == op::glVertexArrayVertexBuffer ? argumentWord(r, 2)
                                                                          : 0;
        std::vector<uint32_t> names{name};
        if (r.opcode == op::glVertexArrayVertexBuffers && !namesAt(r, 3, names)) names.clear();
        for (const uint32_t retained : names) {
            Object* const buffer = retained == 0 ? nullptr : find(at, ObjectType::Buffer, retained);
            if (buffer == nullptr) continue;
            use(at, buffer);
            buffer->opaque = true; // holders are not tracked
        }
        use(at, array);
        return at.effect.kill(cell(at, array->key, r.opcode, rule, r));
    }
    const uint64_t arraySlot = slotOf(Slot::VertexArray), bufferSlot = slotOf(Slot::Buffer, GL_ARRAY_BUFFER);
    Object* const current = bound(at, arraySlot);
    Object* const array = current != nullptr ? current : findOrMake(at, ObjectType::VertexArray, 0);
    at.effect.read(part(c.cells, Part::Binding, arraySlot));
    if (array->name != 0) use(at, array);
    Key above = array->key;
    const bool ofCoordinates = r.opcode == op::glTexCoordPointer || rule.family == Family::ClientCap;
    if (ofCoordinates) {
        at.effect.read(part(c.cells, Part::ClientUnit));
        above = part(above, Part::TextureUnit, c.clientUnit);
    }
    if (rule.family == Family::ClientCap)
        return setClient(at, keys_.child(above, op::glEnableClientState, argumentWord(r, 0)));
    if (r.opcode == op::glEnableVertexAttribArray || r.opcode == op::glDisableVertexAttribArray)
        return setClient(at, keys_.child(above, op::glEnableVertexAttribArray, argumentWord(r, 0)));
    const bool generic = r.opcode == op::glVertexAttribPointer || r.opcode == op::glVertexAttribIPointer ||
                         r.opcode == op::glVertexAttribLPointer || r.opcode == op::glBindVertexBuffer;
    const uint32_t index = generic || rule.family == Family::ArraySet ? argumentWord(r, 0) : 0;
    if (r.opcode == op::glBindVertexBuffers) { // first, count, buffers, ...
        std::vector<uint32_t> names;
        if (!namesAt(r, 2, names)) names.clear();
        for (const uint32_t name : names) {
            Object* const retained = name == 0 ? nullptr : findOrMake(at, ObjectType::Buffer, name);
            if (retained == nullptr) continue;
            use(at, retained);
            retained->opaque = true; // holders are not tracked
        }
        return setClient(at, keys_.child(above, r.opcode, index, argumentWord(r, 1)));
    }
    const Key key = keys_.child(above, r.opcode, index);
    if (rule.family == Family::ArraySet) return setClient(at, key);
    Object* buffer = bound(at, bufferSlot);
    if (r.opcode == op::glBindVertexBuffer) {
        const uint32_t name = argumentWord(r, 1);
        buffer = name == 0 ? nullptr : findOrMake(at, ObjectType::Buffer, name);
    } else {
        at.effect.read(part(c.cells, Part::Binding, bufferSlot));
    }
    if (buffer != nullptr) use(at, buffer);
    setClient(at, key);
    retain(at, array->references[uint64_t{r.opcode} << 32 | (ofCoordinates ? c.clientUnit << 16 : 0) | index], buffer);
}

} // namespace mural::trace
