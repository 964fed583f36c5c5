// Objects of the command filter: creation, deletion, and bindings that keep them alive.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <cstring>

#include "gl_opcodes.hpp"
#include "streamcodec/filter/command_filter.hpp"
#include "streamcodec/effect_rules.hpp"
#include "streamcodec/wire/record.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::filter {

using wire::argumentWord;

namespace {
constexpr size_t kMaxSpared = 16;
} // namespace

bool namesAt(const wire::RecordView& r, size_t word, std::vector<uint32_t>& names) {
    const uint32_t sizeBytes = argumentWord(r, word);
    if (sizeBytes > record::kInlineBytes || (word + 1) * 4 + sizeBytes > r.arguments.size()) return false;
    names.resize(sizeBytes / 4);
    if (!names.empty()) std::memcpy(names.data(), r.arguments.data() + (word + 1) * 4, names.size() * 4);
    return true;
}

Object* CommandFilter::find(Group& group, Kind kind, uint32_t name) const {
    return group.named[static_cast<size_t>(kind)].find(name);
}

Object* CommandFilter::make(Group& group, Kind kind, uint32_t name) {
    if (Object* const there = find(group, kind, name)) return there;
    ++group.objectChanges;
    auto object = std::make_unique<Object>();
    object->kind = kind;
    object->name = name;
    group.named[static_cast<size_t>(kind)].set(name, object.get());
    return (group.objects[static_cast<size_t>(kind)][name] = std::move(object)).get();
}

Object* CommandFilter::named(At& at, Kind kind, uint32_t name) {
    if (name == 0) return nullptr;
    Object* const object = find(at.group, kind, name);
    if (object != nullptr) return object;
    if (at.context.madeByBinding) return make(at.group, kind, name);
    untrack(at); // an error, or an untracked change
    return nullptr;
}

// Uploads to textures without a name are not deferred.
Object* CommandFilter::textureAt(At& at, uint32_t target) {
    const size_t index = targetIndex(target);
    return index == kTextureTargets ? nullptr : at.context.units[at.context.unit][index];
}

Object* CommandFilter::bufferAt(const Context& c, uint32_t target) const {
    if (target == GL_ELEMENT_ARRAY_BUFFER) return c.array->indices;
    for (const auto& [bound, object] : c.buffers)
        if (bound == target) return object;
    return nullptr;
}

VertexArray* CommandFilter::makeArray(Context& c, uint32_t name) {
    ++c.group->objectChanges;
    if (!c.sparedArrays.empty()) {
        auto node = std::move(c.sparedArrays.back());
        c.sparedArrays.pop_back();
        node.key() = name;
        node.mapped().buffers.clear();
        node.mapped().indices = nullptr;
        c.arrays.insert(std::move(node)); // unless that name exists
    }
    VertexArray* const array = &c.arrays[name];
    c.arraysNamed.set(name, array);
    return array;
}

void CommandFilter::generate(At& at) {
    const RecordView& r = at.r;
    Context& c = at.context;
    const EffectRule& rule = effectRuleOf(r.opcode);
    if (rule.kind == EffectKind::Create) {
        Object* const old = find(at.group, Kind::Program, argumentWord(r, rule.resultWord));
        if (old == nullptr) return;
        releaseOne(at, *old);
        old->forget();
        old->target = 0;
        old->open = false;
        return;
    }
    const ObjectType type = rule.type;
    if (type != ObjectType::Texture && type != ObjectType::Buffer && type != ObjectType::VertexArray) return;
    std::vector<uint32_t>& names = names_;
    if (!namesAt(r, rule.nameWord, names)) return untrack(at);
    for (const uint32_t name : names) {
        if (type == ObjectType::VertexArray) {
            makeArray(c, name);
            continue;
        }
        const Kind kind = type == ObjectType::Texture ? Kind::Texture : Kind::Buffer;
        if (find(at.group, kind, name) != nullptr) return untrack(at); // GL never returns a name twice
        Object* const object = make(at.group, kind, name);
        if (r.opcode == op::glCreateTextures) object->target = argumentWord(r, 0);
    }
}

void CommandFilter::deleteNames(At& at) {
    const RecordView& r = at.r;
    const EffectRule& rule = effectRuleOf(r.opcode);
    Context& c = at.context;
    if (rule.kind == EffectKind::ProgramDelete) {
        // A program lives while it is current anywhere.
        Object* const program = find(at.group, Kind::Program, argumentWord(r, 0));
        return program != nullptr ? releaseOne(at, *program) : void();
    }
    std::vector<uint32_t>& names = names_;
    if (!namesAt(r, 1, names)) return untrack(at);
    for (const uint32_t name : names) {
        if (at.group.untracked) return;
        if (rule.type == ObjectType::Framebuffer && name == c.drawFramebuffer) c.drawFramebuffer = 0;
        if (rule.type == ObjectType::VertexArray && name != 0) {
            const VertexArray* const array = c.arraysNamed.find(name);
            if (array == nullptr) continue;
            if (c.array == array) c.array = c.arraysNamed.find(0);
            c.arraysNamed.set(name, nullptr);
            auto node = c.arrays.extract(name);
            if (c.sparedArrays.size() < kMaxSpared) c.sparedArrays.push_back(std::move(node));
            ++at.group.objectChanges;
            c.needs = true;
        }
        if (rule.type != ObjectType::Texture && rule.type != ObjectType::Buffer) continue;
        if (Object* const object =
                find(at.group, rule.type == ObjectType::Texture ? Kind::Texture : Kind::Buffer, name))
            deleteObject(at, object);
    }
}

void CommandFilter::deleteObject(At& at, Object* object) {
    Context& c = at.context;
    // An object bound elsewhere outlives its name, and can then no longer be bound here.
    bool elsewhere = !c.attribs.empty() || !c.clientAttribs.empty();
    for (const auto& [id, other] : clients_[wire::clientOf(at.stream.id)]) {
        if (other.get() == &c || other->group.get() != &at.group) continue;
        for (const TextureUnit& unit : other->units)
            elsewhere = elsewhere || std::ranges::find(unit, object) != unit.end();
        for (const auto& [target, there] : other->buffers) elsewhere = elsewhere || there == object;
        for (const auto& [name, array] : other->arrays)
            elsewhere = elsewhere || array.indices == object ||
                        std::ranges::any_of(array.buffers, [&](const auto& b) { return b.second == object; });
    }
    if (elsewhere) return untrack(at);
    for (TextureUnit& unit : c.units) std::ranges::replace(unit, object, nullptr);
    for (auto& [target, there] : c.buffers)
        if (there == object) there = nullptr;
    bool inArrays = false; // unbound vertex arrays keep it alive
    for (auto& [name, array] : c.arrays) {
        const bool current = &array == c.array;
        if (array.indices == object) array.indices = nullptr, inArrays = inArrays || !current;
        for (auto& [key, there] : array.buffers)
            if (there == object) there = nullptr, inArrays = inArrays || !current;
    }
    if (inArrays) releaseOne(at, *object);
    dropQueue(at.group, *object);
    ++at.group.objectChanges;
    at.group.named[static_cast<size_t>(object->kind)].set(object->name, nullptr);
    at.group.objects[static_cast<size_t>(object->kind)].erase(object->name);
}

void CommandFilter::openUp(At& at, Object* object) {
    if (object == nullptr || object->open) return;
    releaseOne(at, *object);
    object->open = true;
    object->forget();
}

void CommandFilter::openNamed(At& at, Kind kind, size_t word) {
    openUp(at, find(at.group, kind, argumentWord(at.r, word)));
}

} // namespace mural::filter
