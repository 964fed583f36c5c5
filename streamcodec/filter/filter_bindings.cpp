// Bindings of the command filter: the state that determines the objects that commands refer to.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>

#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/filter/command_filter.hpp"
#include "streamcodec/effect_rules.hpp"
#include "streamcodec/snapshot/texture_targets.hpp"

namespace mural::filter {

using wire::argumentWord;

namespace {

constexpr uint32_t kExternal = 0x8D65; // GL_TEXTURE_EXTERNAL_OES
bool waits(const Object* object) { return object != nullptr && object->waits(); }
bool needs(const VertexArray& array) {
    return waits(array.indices) || std::ranges::any_of(array.buffers, [](const auto& b) { return waits(b.second); });
}

constexpr size_t kMaxUnits = 256, kMaxSaved = 16, kMaxArrayBuffers = 256;

// Targets that no draw reads or writes.
bool onlyForUploads(uint32_t target) {
    return target == GL_ARRAY_BUFFER || target == GL_COPY_READ_BUFFER || target == GL_COPY_WRITE_BUFFER ||
           target == GL_UNIFORM_BUFFER || target == GL_TEXTURE_BUFFER;
}

} // namespace

size_t targetIndex(uint32_t target) {
    switch (target) {
    case GL_TEXTURE_1D: return 0;
    case GL_TEXTURE_2D: return 1;
    case GL_TEXTURE_3D: return 2;
    case GL_TEXTURE_CUBE_MAP: return 3;
    case GL_TEXTURE_RECTANGLE: return 4;
    case GL_TEXTURE_1D_ARRAY: return 5;
    case GL_TEXTURE_2D_ARRAY: return 6;
    case GL_TEXTURE_CUBE_MAP_ARRAY: return 7;
    case GL_TEXTURE_BUFFER: return 8;
    case GL_TEXTURE_2D_MULTISAMPLE: return 9;
    case GL_TEXTURE_2D_MULTISAMPLE_ARRAY: return 10;
    case kExternal: return 11;
    default: return snapshot::isFace(target) ? 3 : kTextureTargets;
    }
}

// Not in a group of several contexts: there, binding again makes changes by other contexts visible.
void CommandFilter::isRedundantBind(At& at) {
    if (!dropsRedundant_ || at.context.group.use_count() > 1 || at.stream.values > 0) return;
    countLeftOut(1, at.r.sizeBytes);
    at.output.drop(at.r.offset, at.r.offset + at.r.sizeBytes);
}

bool isDebugOutput(uint32_t cap) { return cap == GL_DEBUG_OUTPUT || cap == GL_DEBUG_OUTPUT_SYNCHRONOUS; }

void CommandFilter::bind(At& at) {
    Context& c = at.context;
    const RecordView& r = at.r;
    const uint32_t first = argumentWord(r, 0), second = argumentWord(r, 1);
    switch (at.kind.binding) {
    case Binding::Nothing: return;
    case Binding::Unit:
        if (first < GL_TEXTURE0 || first - GL_TEXTURE0 >= kMaxUnits) return untrack(at);
        if (c.unit == first - GL_TEXTURE0) return isRedundantBind(at);
        c.unit = first - GL_TEXTURE0;
        if (c.unit >= c.units.size()) c.units.resize(c.unit + 1);
        return;
    case Binding::ClientUnit: c.clientUnit = first - GL_TEXTURE0; return;
    case Binding::Texture: {
        Object* const object = named(at, Kind::Texture, second);
        if (at.group.untracked) return;
        if (object != nullptr && object == textureAt(at, first) && first != kExternal) return isRedundantBind(at);
        return bindTexture(at, first, c.unit, object);
    }
    case Binding::Buffer:
        if (first == GL_ARRAY_BUFFER && second != 0 && bufferAt(c, first) != nullptr &&
            bufferAt(c, first)->name == second)
            return isRedundantBind(at);
        return bindBuffer(at, first, second);
    case Binding::VertexArray: return bindVertexArray(at, first);
    case Binding::Framebuffer:
        if (first != GL_READ_FRAMEBUFFER) c.drawFramebuffer = second;
        return;
    case Binding::Program: return useProgram(at, first);
    case Binding::Pointer: return arrayPointer(at);
    case Binding::Indexed: return bindIndexed(at);
    case Binding::Cap: // nodes forward driver messages as they occur
        return isDebugOutput(first) ? untrack(at) : void();
    case Binding::ArrayBuffers: return arrayBuffers(at);
    case Binding::PushAttribs: return pushAttribs(at);
    case Binding::PopAttribs: return popAttribs(at);
    case Binding::PushClientAttribs: return pushClientAttribs(at);
    case Binding::PopClientAttribs: return popClientAttribs(at);
    case Binding::Generate: return generate(at);
    case Binding::Delete: return deleteNames(at);
    case Binding::Attach: { // the object is a render target from now on
        const EffectRule& rule = effectRuleOf(r.opcode);
        return rule.type == ObjectType::Texture ? openNamed(at, Kind::Texture, rule.nameWord) : void();
    }
    case Binding::AttachNamed:
        // any of these words may be the name
        for (size_t word = 1; word < 4; ++word) openNamed(at, Kind::Texture, word);
        return;
    case Binding::Pipeline: {
        const uint32_t program = argumentWord(r, effectRuleOf(r.opcode).nameWord);
        return program != 0 ? openUp(at, make(at.group, Kind::Program, program)) : void();
    }
    case Binding::TextureBuffer:
        for (size_t word = 0; word < 4; ++word) openNamed(at, Kind::Buffer, word);
        if (targetIndex(first) == kTextureTargets) return openNamed(at, Kind::Texture, 0);
        return openUp(at, textureAt(at, first));
    }
}

void CommandFilter::bindVertexArray(At& at, uint32_t name) {
    Context& c = at.context;
    VertexArray* const array = c.arraysNamed.find(name);
    if (array != nullptr && array == c.array) return isRedundantBind(at);
    if (array == nullptr && !c.madeByBinding) return untrack(at);
    c.array = array == nullptr ? makeArray(c, name) : array;
    c.needs = c.needs || needs(*c.array);
}

// The objects that refer to these buffers are not tracked.
void CommandFilter::arrayBuffers(At& at) {
    const EffectRule& rule = effectRuleOf(at.r.opcode);
    if (rule.nameWord != rule.valueWord) return openNamed(at, Kind::Buffer, rule.nameWord);
    std::vector<uint32_t> names;
    if (!namesAt(at.r, rule.nameWord, names)) return untrack(at);
    for (const uint32_t name : names) openUp(at, find(at.group, Kind::Buffer, name));
}

void CommandFilter::bindTexture(At& at, uint32_t target, uint32_t unit, Object* object) {
    Context& c = at.context;
    const size_t index = targetIndex(target);
    if (index == kTextureTargets || unit >= kMaxUnits) return untrack(at);
    if (object != nullptr) {
        if (object->target == 0) object->target = target;
        if (object->target != target) return untrack(at); // an error: binds nothing
    }
    if (unit >= c.units.size()) c.units.resize(unit + 1);
    c.units[unit][index] = object;
    c.needs = c.needs || waits(object);
}

void CommandFilter::bindIndexed(At& at) {
    const EffectRule& rule = effectRuleOf(at.r.opcode);
    const uint32_t first = argumentWord(at.r, 0);
    if (rule.type == ObjectType::Buffer) { // shaders may read or write it there
        openNamed(at, Kind::Buffer, rule.nameWord);
        return at.group.untracked ? void() : bindBuffer(at, first, argumentWord(at.r, rule.nameWord));
    }
    if (rule.type != ObjectType::Texture) return; // samplers
    if (hasTrait(at.r.opcode, Trait::ImageBinding)) return openNamed(at, Kind::Texture, rule.nameWord);
    Object* const object = named(at, Kind::Texture, argumentWord(at.r, rule.nameWord));
    if (at.group.untracked) return;
    if (object == nullptr || object->target == 0) return untrack(at); // 0: all targets
    bindTexture(at, object->target, first, object);
}

void CommandFilter::bindBuffer(At& at, uint32_t target, uint32_t name) {
    Context& c = at.context;
    Object* const object = named(at, Kind::Buffer, name);
    if (at.group.untracked) return;
    if (target == GL_ELEMENT_ARRAY_BUFFER) {
        c.array->indices = object;
        c.needs = c.needs || waits(object);
        return;
    }
    if (!onlyForUploads(target)) openUp(at, object);
    for (auto& [bound, there] : c.buffers) {
        if (bound != target) continue;
        there = object;
        return;
    }
    c.buffers.emplace_back(target, object);
}

// A program without a known successful link may be rejected; then the previous one stays current.
void CommandFilter::useProgram(At& at, uint32_t name) {
    Context& c = at.context;
    Object* const object = name == 0 ? nullptr : make(at.group, Kind::Program, name);
    if (c.programSure && object == c.program && (object == nullptr || object->target != 0)) return isRedundantBind(at);
    if (object != nullptr && object->target == 0) {
        std::vector<Object*> programs;
        std::ranges::copy_if(at.group.deferred, std::back_inserter(programs),
                             [](const Object* o) { return o->kind == Kind::Program; });
        if (!programs.empty()) release(at.stream, at.output, at.from, programs);
        c.programSure = false;
    } else {
        c.programSure = true;
    }
    c.program = object;
    c.needs = c.needs || waits(object);
}

void CommandFilter::arrayPointer(At& at) {
    Context& c = at.context;
    const RecordView& r = at.r;
    const bool generic = hasTrait(r.opcode, Trait::ArrayIndex);
    const uint8_t nameWord = effectRuleOf(r.opcode).nameWord;
    Object* object = bufferAt(c, GL_ARRAY_BUFFER);
    if (nameWord != kNoArgumentWord) {
        object = named(at, Kind::Buffer, argumentWord(r, nameWord));
        if (at.group.untracked) return;
    }
    const uint32_t index = generic ? argumentWord(r, 0) : r.opcode == op::glTexCoordPointer ? c.clientUnit : 0;
    const uint32_t key = uint32_t{r.opcode} << 16 | (index & 0xffff);
    c.needs = c.needs || waits(object);
    for (auto& [known, there] : c.array->buffers) {
        if (known != key) continue;
        there = object;
        return;
    }
    if (c.array->buffers.size() == kMaxArrayBuffers) return untrack(at);
    c.array->buffers.emplace_back(key, object);
}

// ---- stacks

void CommandFilter::pushAttribs(At& at) {
    Context& c = at.context;
    if (c.attribs.size() == kMaxSaved) return untrack(at);
    SavedAttribs saved;
    saved.textures = argumentWord(at.r, 0) & GL_TEXTURE_BIT;
    saved.unit = c.unit;
    if (saved.textures) saved.units = c.units;
    c.attribs.push_back(std::move(saved));
}

void CommandFilter::popAttribs(At& at) {
    Context& c = at.context;
    if (c.attribs.empty()) return; // an error
    SavedAttribs saved = std::move(c.attribs.back());
    c.attribs.pop_back();
    if (!saved.textures) return;
    // New units had nothing bound. glPopAttrib also restores texture parameters, which are not part of the images.
    saved.units.resize(std::max(saved.units.size(), c.units.size()));
    c.units = std::move(saved.units);
    c.unit = saved.unit;
    c.needs = true;
}

void CommandFilter::pushClientAttribs(At& at) {
    Context& c = at.context;
    if (c.clientAttribs.size() == kMaxSaved) return untrack(at);
    c.clientAttribs.push_back({argumentWord(at.r, 0), bufferAt(c, GL_PIXEL_UNPACK_BUFFER)});
}

void CommandFilter::popClientAttribs(At& at) {
    Context& c = at.context;
    if (c.clientAttribs.empty()) return; // an error
    const SavedClientAttribs saved = c.clientAttribs.back();
    c.clientAttribs.pop_back();
    if (saved.mask & GL_CLIENT_VERTEX_ARRAY_BIT) return untrack(at);
    if (!(saved.mask & GL_CLIENT_PIXEL_STORE_BIT)) return;
    for (auto& [target, object] : c.buffers)
        if (target == GL_PIXEL_UNPACK_BUFFER) object = saved.unpackBuffer;
}

} // namespace mural::filter
