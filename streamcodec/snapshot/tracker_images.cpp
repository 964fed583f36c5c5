// Textures, renderbuffers and framebuffers.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>

#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/binding_slots.hpp"
#include "streamcodec/snapshot/texture_targets.hpp"

namespace mural::snapshot {
namespace {

uint64_t levelOf(uint32_t target, uint32_t level) {
    return uint64_t{isFace(target) ? target - GL_TEXTURE_CUBE_MAP_POSITIVE_X : 0} << 32 | level;
}

Extent extentAt(const RecordView& r, size_t word, unsigned dimensions) {
    return {argumentWord(r, word), dimensions > 1 ? argumentWord(r, word + 1) : 1,
            dimensions > 2 ? argumentWord(r, word + 2) : 1};
}

} // namespace

// Returns the texture bound at that target.
Object* GlStateTracker::texture(At& at, uint32_t target, bool readsBinding) {
    ContextNames& c = *at.context;
    const uint32_t bindTarget = isFace(target) ? GL_TEXTURE_CUBE_MAP : target;
    const uint64_t slot = slotOf(Slot::Texture, bindTarget, c.unit);
    if (readsBinding) {
        at.effect.read(part(c.cells, Part::ActiveUnit));
        at.effect.read(part(part(c.cells, Part::TextureUnit, c.unit), Part::Binding, slot));
    }
    if (Object* const object = bound(at, slot)) return object;
    // Each target has an unnamed texture, shared by all units.
    constexpr uint32_t kUnnamed = 0xff000000;
    Object* const unnamed = findOrMake(at, ObjectType::Texture, kUnnamed | bindTarget);
    unnamed->target = bindTarget;
    return unnamed;
}

void GlStateTracker::textures(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const uint32_t target = argumentWord(r, 0), level = argumentWord(r, 1);
    if (isProxy(target)) return; // a query only
    const bool named = rule.type == ObjectType::Texture;
    Object* const t = named ? find(at, ObjectType::Texture, target) : texture(at, target, true);
    if (t == nullptr) return unknown(at, false);
    use(at, t);
    if (t->opaque) at.effect.always = true;
    const Key storage = part(t->images, Part::Storage), image = part(storage, Part::Level, levelOf(target, level)),
              data = part(image, Part::Data);
    const unsigned dimensions = rule.dimensions;
    Extent& extent = t->levels[levelOf(target, level)];
    // Images may come from a buffer, and pass through the pixel transfer.
    const bool fromBuffer = bound(at, slotOf(Slot::Buffer, GL_PIXEL_UNPACK_BUFFER)) != nullptr;
    if (fromBuffer) readState(at);
    if (c.transfersPixels) at.effect.read(c.cells);
    if (t->sparse) at.effect.read(part(storage, Part::Pages));
    switch (rule.kind) {
    case EffectKind::TexParameter: return set(at, cell(at, t->key, r.opcode, rule, r), 0);
    case EffectKind::TexImage: { // target, level, format, sizes; multisample: target, samples, format, sizes
        const bool samples = hasTrait(r.opcode, Trait::Multisample);
        const uint64_t id = levelOf(target, samples ? 0 : level);
        t->levels[id] = extentAt(r, 3, dimensions);
        return at.effect.kill(samples ? storage : part(storage, Part::Level, id));
    }
    case EffectKind::TexCopyImage: // target, level, format, x, y, sizes
        extent = extentAt(r, 5, dimensions);
        readPicture(at);
        return at.effect.kill(image);
    case EffectKind::TexStorage: { // target, levels, format, sizes
        Extent e = extentAt(r, 3, dimensions);
        const bool samples = hasTrait(r.opcode, Trait::Multisample);
        const uint32_t kind = named ? t->target : target;
        const uint32_t faces = kind == GL_TEXTURE_CUBE_MAP ? 6 : 1;
        for (uint32_t l = 0; l < (samples ? 1 : std::min(level, 32u)); ++l) {
            for (uint32_t face = 0; face < faces; ++face) t->levels[uint64_t{face} << 32 | l] = e;
            e.width = std::max(1u, e.width / 2);
            if (kind != GL_TEXTURE_1D_ARRAY) e.height = std::max(1u, e.height / 2);
            if (kind == GL_TEXTURE_3D) e.depth = std::max(1u, e.depth / 2);
        }
        return at.effect.kill(storage);
    }
    case EffectKind::TexSubImage:
    case EffectKind::TexCopySubImage: { // target, level, offsets, [copies: x, y,] sizes
        const bool copies = rule.kind == EffectKind::TexCopySubImage;
        if (copies) readPicture(at);
        const Extent offset = extentAt(r, 2, dimensions);
        Extent size = extentAt(r, 2 + dimensions + (copies ? 2 : 0), copies ? std::min(dimensions, 2u) : dimensions);
        const uint64_t x = offset.width, y = dimensions > 1 ? offset.height : 0, z = dimensions > 2 ? offset.depth : 0;
        if (x == 0 && y == 0 && z == 0 && size == extent && extent.width > 0) return at.effect.kill(data);
        const Key slice = part(data, Part::Level, z, size.depth);
        return at.effect.kill(part(slice, Part::Box, x << 32 | y, uint64_t{size.width} << 32 | size.height));
    }
    case EffectKind::TexMipmaps:
        at.effect.read(t->key);
        at.effect.read(t->images);
        return at.effect.kill(part(storage, Part::Mipmaps));
    case EffectKind::TexBuffer: {
        Object* const buffer = find(at, ObjectType::Buffer, argumentWord(r, 2));
        if (buffer != nullptr) {
            use(at, buffer);
            buffer->opaque = true; // lives as long as the texture
        }
        return at.effect.kill(storage);
    }
    default: // shares the image of another object
        t->opaque = true;
        unknown(at, false);
    }
}

// ---- framebuffers

Object* GlStateTracker::framebuffer(At& at, uint32_t target) {
    const uint64_t slot = slotOf(target == GL_READ_FRAMEBUFFER ? Slot::ReadFramebuffer : Slot::DrawFramebuffer);
    at.effect.read(part(at.context->cells, Part::Binding, slot));
    return bound(at, slot);
}

void GlStateTracker::framebuffers(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const uint32_t first = argumentWord(r, 0), point = argumentWord(r, 1);
    switch (rule.kind) {
    case EffectKind::RenderbufferStorage: { // target, [samples,] format, width, height
        const uint64_t slot = slotOf(Slot::Renderbuffer);
        at.effect.read(part(c.cells, Part::Binding, slot));
        Object* const buffer = bound(at, slot);
        if (buffer == nullptr) return;
        use(at, buffer);
        buffer->levels[0] = extentAt(r, hasTrait(r.opcode, Trait::Multisample) ? 3 : 2, 2);
        return at.effect.kill(part(buffer->images, Part::Storage));
    }
    case EffectKind::FramebufferNamed: {
        Object* const target = find(at, ObjectType::Framebuffer, first);
        if (target != nullptr) target->opaque = true;
        return unknown(at, first == 0);
    }
    case EffectKind::DrawBuffers: {
        Object* const target = framebuffer(at, GL_DRAW_FRAMEBUFFER);
        std::vector<uint32_t> buffers{first};
        if (rule.valueWord != kNoArgumentWord && !namesAt(r, rule.valueWord, buffers)) return unknown(at, false);
        if (target == nullptr) {
            c.limits.drawBuffer = buffers.size() == 1 ? buffers[0] : GL_FRONT_AND_BACK;
            c.usesFront = c.usesFront || (c.limits.drawBuffer != GL_BACK && c.limits.drawBuffer != GL_NONE);
            return set(at, part(c.cells, Part::Attachments), GL_COLOR_BUFFER_BIT);
        }
        use(at, target);
        target->drawBuffers = buffers;
        if (!c.attribs.empty()) target->opaque = true; // glPopAttrib restores the previous binding
        return set(at, part(target->key, Part::Data), 0);
    }
    case EffectKind::FramebufferSet: {
        const bool readBuffer = r.opcode == op::glReadBuffer;
        Object* const target = framebuffer(at, readBuffer ? GL_READ_FRAMEBUFFER : first);
        if (target == nullptr && readBuffer && first != GL_BACK && first != GL_NONE) c.usesFront = true;
        if (target == nullptr)
            return readBuffer ? set(at, part(c.cells, Part::Picture), GL_PIXEL_MODE_BIT | 0x40000000) : void();
        use(at, target);
        return set(at, cell(at, target->key, r.opcode, rule, r), 0);
    }
    default: break;
    }
    // Arguments of glFramebufferTexture... and glFramebufferRenderbuffer: target, attachment, [target,] name, [level]
    Object* const target = framebuffer(at, first);
    if (target == nullptr) return; // an error
    use(at, target);
    Attachment attachment;
    const uint32_t name = argumentWord(r, rule.nameWord);
    if (name != 0) {
        attachment.object = find(at, rule.type, name);
        if (attachment.object == nullptr) return unknown(at, false);
        use(at, attachment.object);
        const bool hasTarget = rule.nameWord == 3; // a cube face may be attached by its target
        if (rule.type == ObjectType::Texture)
            attachment.level = levelOf(hasTarget ? argumentWord(r, 2) : 0, argumentWord(r, rule.nameWord + size_t{1}));
        attachment.whole = !hasTrait(r.opcode, Trait::AttachesLayer);
        const bool all = !hasTarget && attachment.whole;
        if (all && attachment.object->target == GL_TEXTURE_CUBE_MAP) attachment.object->opaque = true; // all faces
    }
    const auto attach = [&](uint32_t at1) {
        Attachment& known = target->attachments[at1];
        retain(at, known.object, attachment.object);
        known.level = attachment.level;
        known.whole = attachment.whole;
    };
    if (point == GL_DEPTH_STENCIL_ATTACHMENT) {
        attach(GL_DEPTH_ATTACHMENT);
        attach(GL_STENCIL_ATTACHMENT);
    } else {
        attach(point);
    }
    at.effect.kill(part(target->key, Part::Attachments, point));
}

} // namespace mural::snapshot
