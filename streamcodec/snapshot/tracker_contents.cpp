// Contents of objects: buffers, shaders and programs, queries.
#include <GL/gl.h>
#include <GL/glext.h>
#include <string_view>

#include "streamcodec/command_traits.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/binding_slots.hpp"

namespace mural::snapshot {
namespace {

// An integer uniform may be a sampler; its value is a texture unit.
void noteUnits(Object& program, const RecordView& r, size_t locationWord) {
    if (!hasTrait(r.opcode, Trait::SamplerUniform)) return;
    const uint8_t valueWord = effectRuleOf(r.opcode).valueWord;
    std::vector<uint32_t> values;
    if (valueWord == kNoArgumentWord)
        values.push_back(argumentWord(r, locationWord + 1));
    else if (!namesAt(r, valueWord, values))
        program.anyUnit = true;
    program.units.insert(values.begin(), values.end());
    constexpr size_t kMaxUnits = 256; // larger values are no units: all units count
    if (program.units.size() <= kMaxUnits) return;
    program.units.clear();
    program.anyUnit = true;
}

// Returns true if the shader's source may assign units.
bool namesUnits(const RecordView& r) {
    const std::string_view text(reinterpret_cast<const char*>(r.arguments.data()), r.arguments.size());
    return text.find("binding") != std::string_view::npos || text.find("#include") != std::string_view::npos ||
           text.size() < 64 || argumentWord(r, 2) > record::kInlineBytes || text.find("void") == std::string_view::npos;
}

} // namespace

// ---- buffers

void GlStateTracker::writeBuffer(At& at, Object* buffer, uint64_t offset, uint64_t sizeBytes) {
    const Key data = part(part(buffer->key, Part::Storage), Part::Data);
    if (buffer->opaque && at.context->group->trackingDisabled) at.effect.always = true;
    if (buffer->sparse) at.effect.read(part(part(buffer->key, Part::Storage), Part::Pages));
    if (offset == 0 && sizeBytes == buffer->sizeBytes && sizeBytes > 0)
        at.effect.kill(data);
    else
        at.effect.kill(part(data, Part::Box, offset, sizeBytes)); // an upload of the same range replaces it
}

void GlStateTracker::buffers(At& at, const EffectRule& rule, const RecordView& r) {
    const uint32_t first = argumentWord(r, 0);
    const bool named = rule.type == ObjectType::Buffer;
    const uint64_t slot = slotOf(Slot::Buffer, first);
    Object* const buffer = named ? find(at, ObjectType::Buffer, first) : bound(at, slot);
    if (buffer == nullptr) return named ? unknown(at, false) : void(); // an error
    use(at, buffer);
    if (!named && first == GL_ELEMENT_ARRAY_BUFFER) {
        const uint64_t array = slotOf(Slot::VertexArray);
        at.effect.read(part(at.context->cells, Part::Binding, array));
        Object* const current = bound(at, array);
        Object* const owner = current != nullptr ? current : find(at, ObjectType::VertexArray, 0);
        if (owner != nullptr) at.effect.read(part(owner->key, Part::Binding, slot));
    } else if (!named) {
        at.effect.read(part(at.context->cells, Part::Binding, slot));
    }
    if (rule.kind == EffectKind::BufferData) {
        buffer->sizeBytes = argumentWide(r, 1);
        return at.effect.kill(part(buffer->key, Part::Storage));
    }
    writeBuffer(at, buffer, argumentWide(r, 1), argumentWide(r, 3));
}

// Arguments: buffer, u64 offset, value.
void GlStateTracker::bufferBytes(At& at, const RecordView& r) {
    Object* const buffer = find(at, ObjectType::Buffer, argumentWord(r, 0));
    if (buffer == nullptr) {
        at.effect.always = true;
        return readAll(at);
    }
    use(at, buffer);
    const uint64_t offset = argumentWide(r, 1);
    const uint32_t tag = argumentWord(r, 3);
    writeBuffer(at, buffer, offset, tag == record::kTagBlob ? at.blobBytes : tag);
}

// ---- shaders and programs

void GlStateTracker::shaders(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const uint32_t first = argumentWord(r, 0), second = argumentWord(r, 1);
    if (rule.kind == EffectKind::Uniform) {
        Object* const program = bound(at, slotOf(Slot::Program));
        if (program == nullptr) { // of a pipeline's program, or an error
            if (bound(at, slotOf(Slot::Pipeline)) == nullptr) return;
            at.effect.always = true;
            return readAll(at);
        }
        at.effect.read(part(c.cells, Part::Binding, slotOf(Slot::Program)));
        at.effect.read(part(program->key, Part::Linked));
        if (static_cast<int32_t>(first) < 0) return;
        noteUnits(*program, r, 0);
        return at.effect.kill(cell(at, part(program->key, Part::Uniforms), r.opcode, rule, r));
    }
    if (rule.kind == EffectKind::ArbProgram) {
        Object* const program = bound(at, slotOf(Slot::ArbProgram, first));
        at.effect.read(part(c.cells, Part::Binding, slotOf(Slot::ArbProgram, first)));
        const Key above =
            program != nullptr ? program->key : part(c.cells, Part::Binding, slotOf(Slot::ArbProgram, first, 1));
        return at.effect.kill(cell(at, above, r.opcode, rule, r));
    }
    if (rule.kind == EffectKind::ProgramDelete || rule.kind == EffectKind::ShaderDelete) {
        return deleteOne(at, ObjectType::Program, first);
    }
    const ObjectType type = rule.kind == EffectKind::NamedSet      ? rule.type
                            : rule.kind == EffectKind::PipelineSet ? ObjectType::Pipeline
                                                                   : ObjectType::Program;
    Object* const object = find(at, type, first);
    if (object == nullptr) return unknown(at, false);
    use(at, object);
    switch (rule.kind) {
    case EffectKind::ShaderSet: object->anyUnit = namesUnits(r); return at.effect.kill(part(object->key, Part::Data));
    case EffectKind::ShaderCompile:
        at.effect.read(part(object->key, Part::Data));
        return at.effect.write(part(object->key, Part::Compiled));
    case EffectKind::ProgramAttach:
    case EffectKind::ProgramDetach: {
        Object* const shader = find(at, ObjectType::Program, second);
        Object* const known = shader != nullptr                     ? shader
                              : object->references.contains(second) ? object->references[second]
                                                                    : nullptr;
        if (known == nullptr) return unknown(at, false);
        use(at, known);
        at.effect.write(part(object->key, Part::Attachments));
        return retain(at, object->references[second], rule.kind == EffectKind::ProgramAttach ? known : nullptr);
    }
    case EffectKind::ProgramLink:
        at.effect.read(object->key);
        for (const auto& [name, shader] : object->references) {
            if (shader == nullptr) continue;
            at.effect.read(shader->key);
            object->anyUnit = object->anyUnit || shader->anyUnit;
        }
        return at.effect.write(part(object->key, Part::Linked)); // a failed link replaces nothing
    case EffectKind::PipelineSet: {
        Object* const program = find(at, ObjectType::Program, argumentWord(r, rule.nameWord));
        if (program != nullptr) {
            use(at, program);
            program->opaque = true; // lives as long as the pipeline refers to it
            at.effect.read(program->key);
        }
        return at.effect.kill(cell(at, object->key, r.opcode, rule, r));
    }
    case EffectKind::ProgramUniform:
        noteUnits(*object, r, 1);
        at.effect.read(part(object->key, Part::Linked));
        return at.effect.kill(cell(at, part(object->key, Part::Uniforms), r.opcode, rule, r));
    case EffectKind::ProgramSet:
        if (!hasTrait(r.opcode, Trait::LinkInput))
            at.effect.read(part(object->key, Part::Linked));
        else if (rule.valueWord != kNoArgumentWord) // names are texts: each is a separate cell
            return at.effect.write(part(object->key, Part::Attachments));
        return at.effect.kill(cell(at, object->key, r.opcode, rule, r));
    default: return at.effect.kill(cell(at, object->key, r.opcode, rule, r));
    }
}

// ---- queries, feedback, conditional rendering

void GlStateTracker::queries(At& at, const EffectRule& rule, const RecordView& r) {
    ContextNames& c = *at.context;
    const uint32_t first = argumentWord(r, 0), second = argumentWord(r, 1);
    const bool indexed = hasTrait(r.opcode, Trait::Indexed);
    const uint64_t slot = uint64_t{first} << 32 | (indexed ? second : 0);
    switch (rule.kind) {
    case EffectKind::QueryBegin: {
        const uint32_t name = argumentWord(r, rule.nameWord);
        if (name == 0) return;
        Object* const query = findOrMake(at, ObjectType::Query, name);
        use(at, query);
        at.effect.kill(query->images);
        return retain(at, c.queries[slot], query);
    }
    case EffectKind::QueryEnd: {
        const auto found = c.queries.find(slot);
        if (found == c.queries.end() || found->second == nullptr) return;
        const Key data = found->second->images;
        at.effect.write(data);
        at.effect.add(data, Mode::Close);
        return retain(at, found->second, nullptr);
    }
    case EffectKind::QueryCounter: {
        Object* const query = findOrMake(at, ObjectType::Query, first);
        use(at, query);
        return at.effect.kill(query->images);
    }
    case EffectKind::FeedbackBegin:
        c.feedback = true;
        at.effect.kill(part(c.key, Part::Feedback));
        return readState(at);
    case EffectKind::FeedbackEnd:
        c.feedback = false;
        at.effect.write(part(c.key, Part::Feedback));
        return at.effect.add(part(c.key, Part::Feedback), Mode::Close);
    default: // glEndConditionalRender
        c.limits.conditional = false;
        at.effect.add(part(c.key, Part::Conditional), Mode::Forget);
        at.effect.add(part(c.key, Part::Conditional), Mode::Close);
    }
}

} // namespace mural::snapshot
