// State of contexts: single state cells, matrices, and attribute stacks.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>

#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/snapshot/context_capabilities.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/binding_slots.hpp"

namespace mural::snapshot {
namespace {

constexpr uint32_t kMaybe = 0x40000000; // other bits may save it too

// Returns true if this attribute mask saves the binding.
bool savesBinding(Part stack, uint32_t mask, uint64_t slot) {
    const uint32_t target = slotTarget(slot);
    if (stack == Part::AttribLevel) return slotKind(slot) == Slot::Texture && (mask & GL_TEXTURE_BIT);
    if (slotKind(slot) == Slot::VertexArray) return mask & GL_CLIENT_VERTEX_ARRAY_BIT;
    if (slotKind(slot) != Slot::Buffer) return false;
    if (target == GL_PIXEL_PACK_BUFFER || target == GL_PIXEL_UNPACK_BUFFER) return mask & GL_CLIENT_PIXEL_STORE_BIT;
    return target == GL_ARRAY_BUFFER && (mask & GL_CLIENT_VERTEX_ARRAY_BIT);
}

} // namespace

// Returns the key of the state that the command sets: its opcode, and the selecting arguments.
Key GlStateTracker::cell(const At&, Key above, uint32_t kind, const EffectRule& rule, const RecordView& r) {
    Key key = above;
    uint64_t words[4] = {};
    size_t n = 0;
    for (size_t i = 0; i < rule.selectors; ++i) {
        words[n++] = argumentWord(r, rule.selectorWords[i]);
        if (n < 4 || i + 1 == rule.selectors) continue;
        key = keys_.child(key, kind, words[0] << 32 | words[1], words[2] << 32 | words[3]);
        words[0] = words[1] = words[2] = words[3] = 0;
        n = 0;
    }
    return keys_.child(key, kind, words[0] << 32 | words[1], words[2] << 32 | words[3]);
}

void GlStateTracker::set(At& at, Key key, uint32_t attribBits) {
    at.effect.kill(key);
    if (at.context->attribs.empty() || attribBits == kNoAttribBit) return;
    // Any level of the stack may restore the previous value, so the command that restores it stays with this one.
    if (attribBits == 0 || (attribBits & GL_TEXTURE_BIT)) at.context->attribs.back().texturesTouched = true;
    for (const SavedAttribs& level : at.context->attribs)
        if (attribBits == 0 || (attribBits & (kMaybe | level.mask))) at.effect.read(level.key);
    SavedAttribs& saved = at.context->attribs.back();
    const auto known = std::ranges::find(saved.touched, key, &std::pair<Key, uint32_t>::first);
    if (known == saved.touched.end()) saved.touched.emplace_back(key, attribBits);
}

void GlStateTracker::setClient(At& at, Key key) {
    at.effect.kill(key);
    if (at.context->clientAttribs.empty()) return;
    for (const SavedAttribs& level : at.context->clientAttribs) at.effect.read(level.key);
    SavedAttribs& saved = at.context->clientAttribs.back();
    if (std::ranges::find(saved.touched, key, &std::pair<Key, uint32_t>::first) == saved.touched.end())
        saved.touched.emplace_back(key, 0);
}

void GlStateTracker::state(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const uint32_t first = argumentWord(r, 0);
    const Key unit = part(c.cells, Part::ActiveUnit);
    switch (rule.kind) {
    case EffectKind::Cap: return cap(at, rule, r);
    case EffectKind::Limit: limit(at, r); break;
    case EffectKind::ActiveTexture: c.unit = first - GL_TEXTURE0; return set(at, unit, rule.attribBits);
    case EffectKind::MatrixMode: c.matrixMode = first; return set(at, part(c.cells, Part::MatrixMode), rule.attribBits);
    case EffectKind::ListBase: c.listBase = first; return set(at, part(c.cells, Part::ListBase), rule.attribBits);
    case EffectKind::ClientActiveTexture:
        c.clientUnit = first - GL_TEXTURE0;
        return setClient(at, part(c.cells, Part::ClientUnit));
    case EffectKind::ClientCell: return setClient(at, cell(at, c.cells, r.opcode, rule, r));
    case EffectKind::AttribPush: return pushAttribs(at, c.attribs, Part::AttribLevel, first);
    case EffectKind::AttribPop: return popAttribs(at, c.attribs, Part::AttribLevel);
    case EffectKind::ClientPush: return pushAttribs(at, c.clientAttribs, Part::ClientAttribLevel, first);
    case EffectKind::ClientPop: return popAttribs(at, c.clientAttribs, Part::ClientAttribLevel);
    case EffectKind::UnitCell:
    case EffectKind::UnitCellOfMatrix:
        at.effect.read(unit);
        if (rule.kind == EffectKind::UnitCellOfMatrix) at.effect.read(part(c.key, Part::Matrices));
        return set(at, cell(at, part(c.cells, Part::TextureUnit, c.unit), r.opcode, rule, r), rule.attribBits);
    case EffectKind::CellOfAll: // the raster position depends on all vertex state and has several setters
        readState(at);
        return set(at, part(c.cells, Part::Config), rule.attribBits);
    case EffectKind::CellOfMatrix: at.effect.read(part(c.key, Part::Matrices)); break;
    case EffectKind::PatternedCell: readState(at); break; // the pattern may be in a buffer
    case EffectKind::Color:
        // With GL_COLOR_MATERIAL it also sets the material, which stays after glDisable even if the colour is replaced.
        if (c.limits.colorMaterial) colorMaterial(at);
        return set(at, part(c.cells, Part::Color), rule.attribBits); // one cell for all setters
    default: break;
    }
    if (r.opcode == op::glColorMaterial) {
        c.colorMaterialMode = uint64_t{first} << 32 | argumentWord(r, 1);
        if (c.limits.colorMaterial) colorMaterial(at);
        return set(at, part(c.cells, Part::MaterialMode), rule.attribBits);
    }
    if (hasTrait(r.opcode, Trait::PixelTransfer)) c.transfersPixels = true;
    set(at, cell(at, c.cells, r.opcode, rule, r), rule.attribBits);
}

// The material takes the current colour.
void GlStateTracker::colorMaterial(At& at) {
    ContextNames& c = *at.context;
    at.effect.read(part(c.cells, Part::Color));
    at.effect.read(part(c.cells, Part::MaterialMode));
    at.effect.read(keys_.child(c.cells, op::glEnable, GL_COLOR_MATERIAL));
    set(at, part(c.cells, Part::ColorMaterial, c.colorMaterialMode), GL_LIGHTING_BIT | kMaybe);
}

void GlStateTracker::cap(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const uint32_t what = argumentWord(r, 0);
    const bool on = !hasTrait(r.opcode, Trait::TurnsOff);
    const bool indexed = hasTrait(r.opcode, Trait::Indexed);
    const bool ofUnit = !indexed && !isContextCap(what);
    if (what == GL_SCISSOR_TEST && indexed) c.limits.unknown = true;
    if (what == GL_SCISSOR_TEST && !indexed) c.limits.scissor = on;
    if (what == GL_RASTERIZER_DISCARD) c.limits.discard = on;
    if (what == GL_DEPTH_TEST && on) c.depthTested = true;
    if (what == GL_STENCIL_TEST && on) c.stencilTested = true;
    if (what == GL_COLOR_MATERIAL) {
        c.limits.colorMaterial = on;
        if (on) colorMaterial(at);
    }
    if (ofUnit) at.effect.read(part(c.cells, Part::ActiveUnit));
    const Key above = ofUnit ? part(c.cells, Part::TextureUnit, c.unit) : c.cells;
    // glEnable and glDisable set one cell; indexed variants set it for one buffer.
    const Key all = keys_.child(above, op::glEnable, what);
    const bool known = isContextCap(what) && what != GL_RASTERIZER_DISCARD && what != GL_PRIMITIVE_RESTART &&
                       what != GL_PRIMITIVE_RESTART_FIXED_INDEX && what != GL_TEXTURE_CUBE_MAP_SEAMLESS &&
                       what != GL_FRAMEBUFFER_SRGB;
    set(at, indexed ? keys_.child(all, op::glEnablei, argumentWord(r, 1)) : all,
        known || ofUnit ? rule.attribBits | kMaybe : 0);
}

void GlStateTracker::limit(At& at, const RecordView& r) {
    Limits& l = at.context->limits;
    const uint32_t first = argumentWord(r, 0);
    switch (r.opcode) {
    case op::glColorMask:
        l.colorMasked = !(first & 0xff) || !(argumentWord(r, 1) & 0xff) || !(argumentWord(r, 2) & 0xff);
        l.alphaMasked = !(argumentWord(r, 3) & 0xff);
        return;
    case op::glDepthMask: l.depthMasked = !(first & 0xff); return;
    case op::glStencilMask: l.stencilMasked = (first & 0xff) != 0xff; return;
    default: l.unknown = true; // of one buffer or viewport
    }
}

// ---- matrices

void GlStateTracker::matrix(At& at, const EffectRule& rule, const RecordView&) {
    ContextNames& c = *at.context;
    const bool ofUnit = c.matrixMode == GL_TEXTURE;
    const uint64_t id = uint64_t{c.matrixMode} << 32 | (ofUnit ? c.unit : 0);
    const Key stack = part(part(c.key, Part::Matrices), Part::Matrix, id);
    uint32_t& depth = c.matrixDepths[id];
    const Key level = part(stack, Part::MatrixLevel, depth), value = part(level, Part::MatrixValue);
    const auto readPlace = [&] {
        at.effect.read(part(c.cells, Part::MatrixMode));
        if (ofUnit) at.effect.read(part(c.cells, Part::ActiveUnit));
        at.effect.read(part(level, Part::Made)); // depends on the pushes so far
    };
    switch (rule.kind) {
    case EffectKind::MatrixLoad: at.effect.kill(value); return readPlace();
    case EffectKind::MatrixChange: at.effect.write(value); return readPlace();
    case EffectKind::MatrixPush:
        ++depth;
        at.effect.kill(part(stack, Part::MatrixLevel, depth));
        at.effect.read(value);
        return readPlace();
    default:                    // glPopMatrix
        if (depth == 0) return; // an error
        --depth;
        at.effect.add(level, Mode::Forget);
        at.effect.add(level, Mode::Close);
        at.effect.read(part(c.cells, Part::MatrixMode));
        if (ofUnit) at.effect.read(part(c.cells, Part::ActiveUnit));
    }
}

// ---- stacks of attributes

void GlStateTracker::pushAttribs(At& at, std::vector<SavedAttribs>& stack, Part kind, uint32_t mask) {
    ContextNames& c = *at.context;
    SavedAttribs saved;
    saved.mask = mask;
    saved.key = part(c.key, kind, stack.size());
    saved.unit = c.unit;
    saved.clientUnit = c.clientUnit;
    saved.matrixMode = c.matrixMode;
    saved.listBase = c.listBase;
    saved.limits = c.limits;
    saved.colorMaterialMode = c.colorMaterialMode;
    for (const auto& [slot, object] : c.bindings)
        if (savesBinding(kind, mask, slot)) saved.bindings.emplace_back(slot, object != nullptr ? object->name : 0);
    at.effect.kill(saved.key);
    at.effect.add(saved.key, Mode::Open);
    stack.push_back(std::move(saved));
}

void GlStateTracker::popAttribs(At& at, std::vector<SavedAttribs>& stack, Part kind) {
    ContextNames& c = *at.context;
    if (stack.empty()) return; // an error
    const SavedAttribs saved = std::move(stack.back());
    stack.pop_back();
    const auto touchBelow = [&](Key key, uint32_t bits) {
        if (!stack.empty() && std::ranges::find(stack.back().touched, key, &std::pair<Key, uint32_t>::first) ==
                                  stack.back().touched.end())
            stack.back().touched.emplace_back(key, bits);
    };
    // glPopAttrib rebinds textures and restores their parameters, whatever happened to their names; this is not
    // tracked.
    const bool textures = kind == Part::AttribLevel && (saved.mask & GL_TEXTURE_BIT) && saved.texturesTouched;
    if (saved.texturesTouched && !stack.empty()) stack.back().texturesTouched = true;
    if (textures) {
        at.effect.always = true;
        readState(at);
    }
    for (const auto& [key, bits] : saved.touched) {
        if (!textures && (bits & saved.mask & ~kMaybe)) {
            at.effect.add(key, Mode::Restore);
            continue;
        }
        if (bits == 0 || (bits & kMaybe)) at.effect.write(key);
        touchBelow(key, bits);
    }
    at.effect.add(saved.key, Mode::Close);
    const uint32_t mask = saved.mask;
    for (auto& [slot, object] : c.bindings) {
        if (!savesBinding(kind, mask, slot)) continue;
        const auto was = std::ranges::find(saved.bindings, slot, &std::pair<uint64_t, uint32_t>::first);
        retain(at, object,
               was == saved.bindings.end() || was->second == 0 ? nullptr
                                                               : find(at, typeOf(slotKind(slot)), was->second));
    }
    if (kind == Part::ClientAttribLevel) {
        if (mask & GL_CLIENT_VERTEX_ARRAY_BIT) c.clientUnit = saved.clientUnit;
        return;
    }
    if (mask & GL_TRANSFORM_BIT) c.matrixMode = saved.matrixMode;
    if (mask & GL_LIST_BIT) c.listBase = saved.listBase;
    if (mask & GL_TEXTURE_BIT) c.unit = saved.unit;
    const Limits now = c.limits;
    if (mask & (GL_ENABLE_BIT | GL_LIGHTING_BIT)) c.limits.colorMaterial = saved.limits.colorMaterial;
    if (mask & GL_LIGHTING_BIT) c.colorMaterialMode = saved.colorMaterialMode;
    if (mask & (GL_ENABLE_BIT | GL_SCISSOR_BIT)) c.limits.scissor = saved.limits.scissor;
    if (mask & GL_COLOR_BUFFER_BIT) {
        c.limits.colorMasked = saved.limits.colorMasked;
        c.limits.alphaMasked = saved.limits.alphaMasked;
        c.limits.drawBuffer = saved.limits.drawBuffer;
    }
    if (mask & GL_DEPTH_BUFFER_BIT) c.limits.depthMasked = saved.limits.depthMasked;
    if (mask & GL_STENCIL_BUFFER_BIT) c.limits.stencilMasked = saved.limits.stencilMasked;
    c.limits.unknown = now.unknown || saved.limits.unknown || now.discard != saved.limits.discard;
}

} // namespace mural::snapshot
