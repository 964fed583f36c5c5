// Display lists: a compiled command takes effect when the list is called, with the state at that time.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <cstring>

#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/context_capabilities.hpp"

namespace mural::snapshot {
namespace {

constexpr uint32_t kMaxNesting = 64;              // GL's limit
constexpr size_t kMaxListBytes = size_t{1} << 20; // remembered effects of one list
constexpr size_t kRememberedWords = 16;           // remembered arguments of one command

enum class Compiles : uint8_t { Compiled, Executed, Unsure };

Compiles compiles(const EffectRule& rule) {
    switch (rule.kind) {
    case EffectKind::Gen:
    case EffectKind::Create:
    case EffectKind::GenLists:
    case EffectKind::Delete:
    case EffectKind::DeleteList:
    case EffectKind::ClientCap:
    case EffectKind::ClientCell:
    case EffectKind::ClientActiveTexture:
    case EffectKind::ClientPush:
    case EffectKind::ClientPop:
    case EffectKind::ArrayPointer:
    case EffectKind::BufferData:
    case EffectKind::BufferSubData: return Compiles::Executed;
    case EffectKind::Bind:
        if (rule.type == ObjectType::Buffer || rule.type == ObjectType::VertexArray) return Compiles::Executed;
        return rule.type == ObjectType::Texture || rule.type == ObjectType::ArbProgram ? Compiles::Compiled
                                                                                       : Compiles::Unsure;
    case EffectKind::Nothing:
    case EffectKind::Cell:
    case EffectKind::CellOfMatrix:
    case EffectKind::CellOfAll:
    case EffectKind::UnitCell:
    case EffectKind::UnitCellOfMatrix:
    case EffectKind::PatternedCell:
    case EffectKind::Cap:
    case EffectKind::Attribute:
    case EffectKind::Color:
    case EffectKind::Limit:
    case EffectKind::ActiveTexture:
    case EffectKind::MatrixMode:
    case EffectKind::ListBase:
    case EffectKind::MatrixLoad:
    case EffectKind::MatrixChange:
    case EffectKind::MatrixPush:
    case EffectKind::MatrixPop:
    case EffectKind::AttribPush:
    case EffectKind::AttribPop:
    case EffectKind::UseProgram:
    case EffectKind::Uniform:
    case EffectKind::TexParameter:
    case EffectKind::TexImage:
    case EffectKind::TexSubImage:
    case EffectKind::TexCopyImage:
    case EffectKind::TexCopySubImage:
    case EffectKind::Draw:
    case EffectKind::Clear:
    case EffectKind::Begin:
    case EffectKind::Vertex:
    case EffectKind::End:
    case EffectKind::CallList:
    case EffectKind::CallLists:
    case EffectKind::DrawBuffers: return Compiles::Compiled;
    default: return Compiles::Unsure;
    }
}

bool draws(EffectKind kind) {
    return kind == EffectKind::Draw || kind == EffectKind::Begin || kind == EffectKind::Vertex ||
           kind == EffectKind::End;
}

// Returns true if the command sets one part of the context's state, independent of other state.
bool setsAlone(const EffectRule& rule, const RecordView& r) {
    switch (rule.kind) {
    case EffectKind::Attribute:
    case EffectKind::Color:
    case EffectKind::Cell:
    case EffectKind::Limit: return true;
    case EffectKind::Cap: return isContextCap(argumentWord(r, 0)) && argumentWord(r, 0) != GL_COLOR_MATERIAL;
    default: return false;
    }
}

// Remembers the effects of a call as records; of repeated setters only the last.
void remember(std::vector<std::byte>& into, const EffectRule& rule, const RecordView& r) {
    const bool repeats = draws(rule.kind) || rule.kind == EffectKind::Attribute || rule.kind == EffectKind::Color;
    const bool movesRaster = hasTrait(r.opcode, Trait::Bitmap);
    const uint16_t opcode = draws(rule.kind) && !movesRaster ? uint16_t{op::glDrawArrays} : r.opcode;
    const bool whole = rule.kind == EffectKind::CallLists || rule.kind == EffectKind::DrawBuffers;
    const bool sets = setsAlone(rule, r);
    size_t words = whole || sets ? r.arguments.size() / 4 : std::min(r.arguments.size() / 4, kRememberedWords);
    if (draws(rule.kind)) words = 0;
    if (repeats) {
        RecordWalk walk(into);
        RecordView known;
        bool drawn = false; // with the current bindings and state
        while (walk.next(known)) {
            bool same = known.opcode == opcode;
            for (size_t i = 0; same && !draws(rule.kind) && i < rule.selectors; ++i)
                same = argumentWord(known, rule.selectorWords[i]) == argumentWord(r, rule.selectorWords[i]);
            const EffectKind before = effectRuleOf(known.opcode).kind;
            if (!draws(rule.kind) || (before != EffectKind::Attribute && before != EffectKind::Color)) drawn = same;
            if (!same || draws(rule.kind)) continue;
            into.erase(into.begin() + static_cast<std::ptrdiff_t>(known.offset),
                       into.begin() + static_cast<std::ptrdiff_t>(known.offset + known.sizeBytes));
            break;
        }
        if (draws(rule.kind) && drawn) return;
    }
    const uint32_t header[2] = {opcode | record::kLongForm << 16, static_cast<uint32_t>(words + 2)};
    const auto* const bytes = reinterpret_cast<const std::byte*>(header);
    into.insert(into.end(), bytes, bytes + sizeof header);
    into.insert(into.end(), r.arguments.begin(), r.arguments.begin() + static_cast<std::ptrdiff_t>(words * 4));
}

} // namespace

// State setters within a primitive or a list are repeated after it as side effects, so the state does not depend on the
// whole command.
bool GlStateTracker::hasSideEffects(At& at, const EffectRule& rule, const RecordView& r) {
    if ((!at.thread.inPrimitive && at.context->callDepth == 0) || at.context->restUnsafe || !setsAlone(rule, r))
        return false;
    if (at.context->callDepth > 0) { // later clears in the list depend on it
        Effect none;
        At of{at.stream, at.client, at.thread, at.context, none, 0};
        state(of, rule, r);
    }
    remember(at.thread.sideEffects, rule, r);
    return true;
}

void GlStateTracker::compiled(At& at, const RecordView& r) {
    const EffectRule& rule = effectRuleOf(r.opcode);
    const Compiles how = compiles(rule);
    if (how == Compiles::Unsure) return unknown(at, true);
    const bool executes = how == Compiles::Executed || at.thread.listExecutes;
    if (rule.kind == EffectKind::AttribPush || rule.kind == EffectKind::AttribPop ||
        rule.kind == EffectKind::CallList || rule.kind == EffectKind::CallLists || r.opcode == op::glColorMaterial ||
        (rule.kind == EffectKind::Cap && argumentWord(r, 0) == GL_COLOR_MATERIAL))
        at.thread.listStacks = true;
    if (how == Compiles::Compiled && rule.kind != EffectKind::Nothing) remember(at.thread.listRecords, rule, r);
    if (rule.kind == EffectKind::Draw) readState(at); // arrays are read from buffers at compile time
    if (!executes) return;
    const uint32_t list = std::exchange(at.thread.list, 0);
    gl(at, r);
    at.thread.list = list;
    at.thread.inPrimitive = false; // the list is one command
}

void GlStateTracker::lists(At& at, const EffectRule& rule, const RecordView& r) {
    const uint32_t first = argumentWord(r, 0), second = argumentWord(r, 1);
    std::vector<uint32_t> names;
    switch (rule.kind) {
    case EffectKind::GenLists: // range, result
        for (uint32_t i = 0; i < first && second != 0 && i < 1u << 20; ++i)
            (void)make(at, ObjectType::List, second + i);
        return;
    case EffectKind::DeleteList:
        if (second > 1u << 20) return unknown(at, false);
        for (uint32_t i = 0; i < second; ++i) deleteOne(at, ObjectType::List, first + i);
        return;
    case EffectKind::NewList: {
        Object* const list = findOrMake(at, ObjectType::List, first);
        at.thread.list = first;
        at.thread.listExecutes = second == GL_COMPILE_AND_EXECUTE; // may call its own previous definition
        at.thread.listRecords.clear();
        at.thread.listStacks = false;
        if (first == 0) return unknown(at, true);
        at.effect.add(part(list->key, Part::Data), at.thread.listExecutes ? Mode::Write : Mode::Kill);
        use(at, list);
        return;
    }
    case EffectKind::EndList: {
        Object* const list = find(at, ObjectType::List, at.thread.list);
        at.thread.list = 0;
        if (list == nullptr) return;
        list->records = std::move(at.thread.listRecords);
        list->stacks = at.thread.listStacks;
        list->opaque = list->records.size() > kMaxListBytes;
        at.thread.listRecords.clear();
        return;
    }
    case EffectKind::CallList: return callList(at, first);
    default: return callLists(at, r);
    }
}

void GlStateTracker::callList(At& at, uint32_t name) {
    Object* const list = find(at, ObjectType::List, name);
    if (list == nullptr) return;
    if (list->opaque) return unknown(at, true);
    if (at.context->callDepth >= kMaxNesting) return;
    use(at, list);
    at.effect.read(list->key);
    ++at.context->callDepth;
    const bool before = std::exchange(at.context->restUnsafe, at.context->restUnsafe || list->stacks);
    RecordWalk walk(list->records);
    RecordView r;
    while (walk.next(r)) gl(at, r);
    at.context->restUnsafe = before;
    --at.context->callDepth;
}

// Arguments: n, type, names.
void GlStateTracker::callLists(At& at, const RecordView& r) {
    const uint32_t n = argumentWord(r, 0), type = argumentWord(r, 1), bytes = argumentWord(r, 2);
    if (bytes > record::kInlineBytes || 12 + bytes > r.arguments.size()) return unknown(at, true);
    const auto* const values = r.arguments.data() + 12;
    const size_t width = type == GL_BYTE || type == GL_UNSIGNED_BYTE     ? 1
                         : type == GL_SHORT || type == GL_UNSIGNED_SHORT ? 2
                         : type == GL_INT || type == GL_UNSIGNED_INT     ? 4
                                                                         : 0;
    if (width == 0 || uint64_t{n} * width > bytes) return unknown(at, true);
    at.effect.read(part(at.context->cells, Part::ListBase));
    const uint32_t base = at.context->listBase;
    std::vector<uint32_t> called;
    for (size_t i = 0; i < n; ++i) {
        uint32_t name = 0;
        std::memcpy(&name, values + i * width, width);
        if (type == GL_BYTE) name = static_cast<uint32_t>(static_cast<int8_t>(name));
        if (type == GL_SHORT) name = static_cast<uint32_t>(static_cast<int16_t>(name));
        called.push_back(base + name);
    }
    for (const uint32_t name : called) callList(at, name);
}

} // namespace mural::snapshot
