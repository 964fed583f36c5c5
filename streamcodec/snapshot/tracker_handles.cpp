// Texture handles (ARB_bindless_texture), and pages of sparse textures and buffers.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>

#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/binding_slots.hpp"

namespace mural::snapshot {

// Returns null if the texture is deleted, and its handle with it.
Object* GlStateTracker::textureOf(At& at, const HandleId& handle) {
    const auto& known = at.context->group->handles;
    const auto found = known.find(handle);
    Object* const object = found == known.end() ? nullptr : find(at, ObjectType::Texture, found->second);
    return object != nullptr && object->handles.contains(handle) ? object : nullptr;
}

void GlStateTracker::handles(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const bool ofImage = hasTrait(r.opcode, Trait::ImageHandle);
    if (rule.kind == EffectKind::HandleResident) {
        const HandleId handle{ofImage, argumentWide(r, 0)};
        const Key key = part(part(c.key, Part::Resident, ofImage), Part::Resident, handle.value);
        if (hasTrait(r.opcode, Trait::TurnsOff))
            c.resident.erase(handle);
        else
            c.resident[handle] = ofImage && argumentWord(r, 2) != GL_READ_ONLY;
        return at.effect.kill(key);
    }
    const uint32_t name = argumentWord(r, 0);
    const HandleId handle{ofImage, argumentWide(r, rule.resultWord)};
    Object* const texture = find(at, ObjectType::Texture, name);
    if (texture == nullptr) return unknown(at, false);
    if (texture->handles.contains(handle)) return; // repeated query
    texture->handles.insert(handle);
    c.group->handles[handle] = name;
    // Drivers number handles in order, and shaders may load handles from memory: none is removed, not even of deleted
    // textures. The texture must be complete, but its pixels are not needed.
    at.effect.always = true;
    use(at, texture);
    at.effect.read(texture->key);
    const Key storage = part(texture->images, Part::Storage);
    for (const auto& [level, extent] : texture->levels)
        at.effect.read(part(part(storage, Part::Level, level), Part::Name));
    at.effect.read(part(storage, Part::Name));
    if (texture->opaque || texture->target == GL_TEXTURE_BUFFER) readState(at);
    if (r.opcode != op::glGetTextureSamplerHandleARB) return;
    Object* const sampler = find(at, ObjectType::Sampler, argumentWord(r, 1));
    if (sampler == nullptr) return unknown(at, false);
    use(at, sampler);
    at.effect.read(sampler->key);
}

// A repeated commitment replaces the earlier one. Writes in between depend on the earlier one.
void GlStateTracker::pages(At& at, const EffectRule& rule, const RecordView& r) {
    const uint32_t first = argumentWord(r, 0);
    if (rule.kind == EffectKind::TexPages) { // target or texture, level, offsets, sizes, commit
        Object* const t =
            rule.type == ObjectType::Texture ? find(at, ObjectType::Texture, first) : texture(at, first, true);
        if (t == nullptr) return unknown(at, false);
        use(at, t);
        if (t->opaque) at.effect.always = true;
        t->sparse = true;
        const Key storage = part(t->images, Part::Storage), all = part(storage, Part::Pages);
        at.effect.read(part(storage, Part::Name));
        const Key level =
            part(all, Part::Level, uint64_t{argumentWord(r, 1)} << 32 | argumentWord(r, 4), argumentWord(r, 7));
        return at.effect.kill(part(level, Part::Box, uint64_t{argumentWord(r, 2)} << 32 | argumentWord(r, 3),
                                   uint64_t{argumentWord(r, 5)} << 32 | argumentWord(r, 6)));
    }
    const uint64_t slot = slotOf(Slot::Buffer, first); // target or buffer, offset, size, commit
    Object* const buffer = rule.type == ObjectType::Buffer ? find(at, ObjectType::Buffer, first) : bound(at, slot);
    if (buffer == nullptr) return unknown(at, false);
    if (rule.type != ObjectType::Buffer) at.effect.read(part(at.context->cells, Part::Binding, slot));
    use(at, buffer);
    buffer->sparse = true;
    const Key storage = part(buffer->key, Part::Storage);
    at.effect.read(part(storage, Part::Name));
    at.effect.kill(part(part(storage, Part::Pages), Part::Box, argumentWide(r, 1), argumentWide(r, 3)));
}

} // namespace mural::snapshot
