// Draws and clears: the planes of render targets that they change. A draw depends on all state, on the textures that it
// may sample, and on the previous contents of its target.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <utility>

#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/binding_slots.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::snapshot {
namespace {

constexpr uint32_t kColor = GL_COLOR_BUFFER_BIT, kDepth = GL_DEPTH_BUFFER_BIT, kStencil = GL_STENCIL_BUFFER_BIT;

bool isColor(uint32_t attachment) { return attachment >= GL_COLOR_ATTACHMENT0 && attachment <= GL_COLOR_ATTACHMENT31; }

uint32_t planesOf(uint32_t buffer) { // argument of glClearBuffer...
    switch (buffer) {
    case GL_COLOR: return kColor;
    case GL_DEPTH: return kDepth;
    case GL_STENCIL: return kStencil;
    case GL_DEPTH_STENCIL: return kDepth | kStencil;
    default: return 0;
    }
}

} // namespace

void GlStateTracker::windowPlanes(At& at, uint32_t mask, bool covers) {
    const ContextNames& c = *at.context;
    const auto found = at.client.windows.find(at.thread.draw);
    if (found == at.client.windows.end()) return; // no render target
    const wire::WindowConfig& config = found->second.config;
    const Limits& l = c.limits;
    const Key picture = found->second.picture;
    covers = covers && !config.stereo;
    const auto plane = [&](Key key, bool whole) { at.effect.add(key, covers && whole ? Mode::Kill : Mode::Write); };
    const bool back = l.drawBuffer == GL_BACK || l.drawBuffer == GL_BACK_LEFT;
    const bool only = back || (!config.doubleBuffer && l.drawBuffer != GL_NONE);
    const bool masked = l.colorMasked || (l.alphaMasked && config.alpha > 0);
    if ((mask & kColor) && l.drawBuffer != GL_NONE) plane(only ? part(picture, Part::Color) : picture, only && !masked);
    if ((mask & kDepth) && config.depth > 0) plane(part(picture, Part::Depth), !l.depthMasked);
    if ((mask & kStencil) && config.stencil > 0) plane(part(picture, Part::Stencil), !l.stencilMasked);
    if (mask & GL_ACCUM_BUFFER_BIT) plane(part(picture, Part::Data), true);
}

void GlStateTracker::framebufferPlanes(At& at, Object& target, uint32_t mask, bool covers) {
    const Limits& l = at.context->limits;
    if (target.opaque) at.effect.always = true;
    const Extent* common = nullptr;
    for (const auto& [point, a] : target.attachments) {
        if (a.object == nullptr) continue;
        const auto level = a.object->levels.find(a.level);
        covers = covers && a.whole && level != a.object->levels.end() && level->second.depth == 1 &&
                 (common == nullptr || *common == level->second);
        if (level != a.object->levels.end()) common = &level->second;
    }
    covers = covers && common != nullptr && !at.context->group->trackingDisabled;
    for (const auto& [point, a] : target.attachments) {
        if (a.object == nullptr) continue;
        const uint32_t plane = isColor(point)                   ? kColor
                               : point == GL_DEPTH_ATTACHMENT   ? kDepth
                               : point == GL_STENCIL_ATTACHMENT ? kStencil
                                                                : 0;
        if (plane != 0 && !(mask & plane)) continue;
        if (a.object->opaque || at.context->group->trackingDisabled) at.effect.always = true;
        const Key storage = part(a.object->images, Part::Storage);
        const bool texture = a.object->type == ObjectType::Texture;
        const Key image = texture ? part(storage, Part::Level, a.level) : storage;
        Key data = part(image, Part::Data);
        const bool drawn = target.drawBuffers.empty()
                               ? point == GL_COLOR_ATTACHMENT0
                               : std::ranges::find(target.drawBuffers, point) != target.drawBuffers.end();
        bool whole = plane == kColor && drawn && !l.colorMasked && !l.alphaMasked;
        if (plane == kDepth) data = part(data, Part::Depth), whole = !l.depthMasked;
        if (plane == kStencil) data = part(data, Part::Stencil), whole = !l.stencilMasked;
        at.effect.add(data, covers && whole ? Mode::Kill : Mode::Write);
        at.effect.read(part(image, Part::Name)); // its storage
        if (a.object->sparse) at.effect.read(part(storage, Part::Pages));
    }
}

void GlStateTracker::planes(At& at, uint32_t mask, bool covers) {
    const Limits& l = at.context->limits;
    covers = covers && !l.scissor && !l.discard && !l.conditional && !l.unknown;
    if (Object* const target = bound(at, slotOf(Slot::DrawFramebuffer)))
        return framebufferPlanes(at, *target, mask, covers);
    windowPlanes(at, mask, covers);
}

// Memory that shaders and queries may write besides render targets.
void GlStateTracker::writeMemory(At& at) {
    ContextNames& c = *at.context;
    for (const auto& [slot, query] : c.queries)
        if (query != nullptr) at.effect.write(query->images);
    for (const auto& [slot, object] : c.bindings) {
        if (object == nullptr) continue;
        const bool buffer =
            slotKind(slot) == Slot::IndexedBuffer &&
            (slotTarget(slot) == GL_SHADER_STORAGE_BUFFER || slotTarget(slot) == GL_ATOMIC_COUNTER_BUFFER ||
             (slotTarget(slot) == GL_TRANSFORM_FEEDBACK_BUFFER && c.feedback));
        if (!buffer && slotKind(slot) != Slot::Image) continue;
        if (object->opaque) at.effect.always = true;
        at.effect.write(part(buffer ? object->key : object->images, Part::Storage));
        if (!buffer) at.effect.read(object->images);
    }
    for (const auto& [handle, written] : c.resident) {
        const Object* const image = handle.ofImage && written ? textureOf(at, handle) : nullptr;
        if (image == nullptr) continue;
        at.effect.write(part(image->images, Part::Storage));
        at.effect.read(image->images);
        if (!image->opaque && image->target != GL_TEXTURE_BUFFER) continue;
        at.effect.always = true; // the owner of this memory is not tracked
        readAll(at);
    }
}

void GlStateTracker::draw(At& at) {
    const ContextNames& c = *at.context;
    planes(at, kColor | (c.depthTested ? kDepth : 0) | (c.stencilTested ? kStencil : 0), false);
    writeMemory(at);
    if (c.group->trackingDisabled && bound(at, slotOf(Slot::DrawFramebuffer)) != nullptr) at.effect.always = true;
    readState(at);
    readTextures(at);
}

void GlStateTracker::drawBitmap(At& at) {
    at.effect.write(part(at.context->cells, Part::Config)); // moves the raster position
    draw(at);
}

// Mesa batches bitmaps, and nodes flush them at requests (nodes/replay/features/bitmap_flush.cpp). Without the request
// they would be drawn later with other state, for which Mesa may crash. The request therefore stays as long as the
// bitmaps.
void GlStateTracker::drawGathered(At& at) {
    if (at.context != nullptr && std::exchange(at.context->gathersBitmaps, false)) drawBitmap(at);
}

// Reads the bound textures that the current draw may sample.
void GlStateTracker::readTextures(At& at) {
    const Object* const program = bound(at, slotOf(Slot::Program));
    const bool any = program == nullptr || program->anyUnit;
    for (const auto& [slot, object] : at.context->bindings) {
        if (object == nullptr || slotKind(slot) != Slot::Texture) continue;
        if (object->opaque) readAll(at); // may be the image of another object
        const uint32_t unit = slotIndex(slot);
        if (any || unit == 0 || program->units.contains(unit)) at.effect.read(object->images);
    }
    for (const auto& [handle, written] : at.context->resident) {
        const Object* const object = textureOf(at, handle);
        if (object == nullptr) continue;
        if (object->opaque) readAll(at);
        at.effect.read(object->images);
    }
}

// Reads the source of copies.
void GlStateTracker::readPicture(At& at) {
    readState(at);
    const Object* const from = bound(at, slotOf(Slot::ReadFramebuffer));
    if (from == nullptr) {
        const auto window = at.client.windows.find(at.thread.read);
        if (window != at.client.windows.end()) at.effect.read(window->second.picture);
        return;
    }
    if (from->opaque || at.context->group->trackingDisabled) return readAll(at);
    for (const auto& [point, a] : from->attachments) {
        if (a.object == nullptr) continue;
        if (a.object->opaque) readAll(at);
        at.effect.read(a.object->images);
    }
}

void GlStateTracker::clear(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const uint32_t first = argumentWord(r, 0);
    switch (rule.kind) {
    case EffectKind::Clear:
    case EffectKind::ClearBuffer: {
        const bool buffer = rule.kind == EffectKind::ClearBuffer;
        const uint32_t mask = buffer ? planesOf(first) : first;
        at.effect.read(c.key);
        if (c.limits.conditional) readState(at);
        // glClearBuffer... clears one of several colour buffers.
        const Object* const target = bound(at, slotOf(Slot::DrawFramebuffer));
        const auto colors = target == nullptr ? 1 : std::ranges::count_if(target->attachments, [](const auto& a) {
            return a.second.object != nullptr && isColor(a.first);
        });
        return planes(at, mask, !buffer || mask != kColor || (colors == 1 && argumentWord(r, 1) == 0));
    }
    case EffectKind::Blit: { // source, x0, y0, x1, y1 of the destination, mask
        readPicture(at);
        const auto window = at.client.windows.find(at.thread.draw);
        const bool covers = bound(at, slotOf(Slot::DrawFramebuffer)) == nullptr && window != at.client.windows.end() &&
                            argumentWord(r, 4) == 0 && argumentWord(r, 5) == 0 &&
                            argumentWord(r, 6) == window->second.config.width &&
                            argumentWord(r, 7) == window->second.config.height;
        return planes(at, argumentWord(r, 8), covers);
    }
    case EffectKind::Compute:
        readState(at);
        readTextures(at);
        return writeMemory(at);
    case EffectKind::Barrier: return writeMemory(at);
    default: break;
    }
    if (hasTrait(r.opcode, Trait::Bitmap)) {
        c.gathersBitmaps = true;
        return drawBitmap(at);
    }
    if (hasTrait(r.opcode, Trait::Accumulates)) planes(at, GL_ACCUM_BUFFER_BIT, first == GL_LOAD);
    if (hasTrait(r.opcode, Trait::AllPlanes)) planes(at, kColor | kDepth | kStencil, false);
    if (r.opcode == op::glCopyPixels) readPicture(at);
    draw(at);
}

} // namespace mural::snapshot
