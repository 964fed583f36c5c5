// Display lists: a compiled command takes effect when the list is called, with the state at that time.
#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <cstring>

#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"
#include "streamcodec/snapshot/context_capabilities.hpp"

namespace mural::trace {
namespace {

constexpr uint32_t kMaxNesting = 64;              // GL's limit
constexpr size_t kMaxListBytes = size_t{1} << 20; // remembered effects of one list
constexpr size_t kRememberedWords = 16;           // remembered arguments of one command

enum class Compiles : uint8_t { Compiled, Executed, Unsure };

Compiles compiles(const Rule& rule) {
    switch (rule.family) {
    case Family::Gen:
    case Family::Create:
    case Family::GenLists:
    case Family::Delete:
    case Family::DeleteList:
    case Family::ClientCap:
    case Family::ClientCell:
    case Family::ClientActiveTexture:
    case Family::ClientPush:
    case Family::ClientPop:
    case Family::ArrayPointer:
    case Family::BufferData:
    case Family::BufferSubData: return Compiles::Executed;
    case Family::Bind:
        if (rule.type == ObjectType::Buffer || rule.type == ObjectType::VertexArray) return Compiles::Executed;
        return rule.type == ObjectType::Texture || rule.type == ObjectType::ArbProgram ? Compiles::Compiled
                                                                                       : Compiles::Unsure;
    case Family::Nothing:
    case Family::Cell:
    case Family::CellOfMatrix:
    case Family::CellOfAll:
    case Family::UnitCell:
    case Family::UnitCellOfMatrix:
    case Family::PatternedCell:
    case Family::Cap:
    case Family::Attribute:
    case Family::Color:
    case Family::Limit:
    case Family::ActiveTexture:
    case Family::MatrixMode:
    case Family::ListBase:
    case Family::MatrixLoad:
    case Family::MatrixChange:
    case Family::MatrixPush:
    case Family::MatrixPop:
    case Family::AttribPush:
    case Family::AttribPop:
    case Family::UseProgram:
    case Family::Uniform:
    case Family::TexParameter:
    case Family::TexImage:
    case Family::TexSubImage:
    case Family::TexCopyImage:
    case Family::TexCopySubImage:
    case Family::Draw:
    case Family::Clear:
    case Family::Begin:
    case Family::Vertex:
    case Family::End:
    case Family::CallList:
    case Family::CallLists:
    case Family::DrawBuffers: return Compiles::Compiled;
    default: return Compiles::Unsure;
    }
}

bool draws(Family family) {
    return family == Family::Draw || family == Family::Begin || family == Family::Vertex || family == Family::End;
}

// Returns true if the command sets one part of the context's state, independent of other state.
bool setsAlone(const Rule& rule, const RecordView& r) {
    switch (rule.family) {
    case Family::Attribute:
    case Family::Color:
    case Family::Cell:
    case Family::Limit: return true;
    case Family::Cap: return isContextCap(argumentWord(r, 0)) && argumentWord(r, 0) != GL_COLOR_MATERIAL;
    default: return false;
    }
}

// Remembers the effects of a call as records; of repeated setters only the last.
void remember(std::vector<std::byte>& into, const Rule& rule, const RecordView& r) {
    const bool repeats = draws(rule.family) || rule.family == Family::Attribute || rule.family == Family::Color;
    const bool movesRaster = hasTrait(r.opcode, Trait::Bitmap);
    const uint16_t opcode = draws(rule.family) && !movesRaster ? uint16_t{op::glDrawArrays} : r.opcode;
    const bool whole = rule.family == Family::CallLists || rule.family == Family::DrawBuffers;
    const bool sets = setsAlone(rule, r);
    size_t words = whole || sets ? r.arguments.size() / 4 : std::min(r.arguments.size() / 4, kRememberedWords);
    if (draws(rule.family)) words = 0;
    if (repeats) {
        RecordWalk walk(into);
        RecordView known;
        bool drawn = false; // with the current bindings and state
        while (walk.next(known)) {
            bool same = known.opcode == opcode;
            for (size_t i = 0; same && !draws(rule.family) && i < rule.selectors; ++i)
                same = argumentWord(known, rule.selectorWords[i]) == argumentWord(r, rule.selectorWords[i]);
            const Family before = ruleOf(known.opcode).family;
            if (!draws(rule.family) || (before != Family::Attribute && before != Family::Color)) drawn = same;
            if (!same || draws(rule.family)) continue;
            into.erase(into.begin() + static_cast<std::ptrdiff_t>(known.offset),
                       into.begin() + static_cast<std::ptrdiff_t>(known.offset + known.sizeBytes));
            break;
        }
        if (draws(rule.family) && drawn) return;
    }
    const uint32_t header[2] = {opcode | record::kLongForm << 16, static_cast<uint32_t>(words + 2)};
    const auto* const bytes = reinterpret_cast<const std::byte*>(header);
    into.insert(into.end(), bytes, bytes + sizeof header);
    into.insert(into.end(), r.arguments.begin(), r.arguments.begin() + static_cast<std::ptrdiff_t>(words * 4));
}

} // namespace

// State setters within a primitive or a list are repeated after it as side effects, so the state does not depend on the
// whole command.
bool GlStateTracker::hasSideEffects(At& at, const Rule& rule, const RecordView& r) {
    if ((!at.thread.inPrimitive && at.context->callDepth == 0) || at.context->restUnsafe || !setsAlone(rule, r))
        return false;
    if (at.context->callDepth > 0) { // later clears in the list depend on it
        Effect none;
        At of{at.stream, at.client, at.thread, at.context, none, 0};
        state(of, rule, r);
    }
    remember(at.thread.rest, rule, r);
    return true;
}

void GlStateTracker::compiled(At& at, const RecordView& r) {
    const Rule& rule = ruleOf(r.opcode);
    const Compiles how = compiles(rule);
    if (how == Compiles::Unsure) return unknown(at, true);
    const bool executes = how == Compiles::Executed || at.thread.listExecutes;
    if (rule.family == Family::AttribPush || rule.family == Family::AttribPop || rule.family == Family::CallList ||
        rule.family == Family::CallLists || r.opcode == op::glColorMaterial ||
        (rule.family == Family::Cap && argumentWord(r, 0) == GL_COLOR_MATERIAL))
        at.thread.listStacks = true;
    if (how == Compiles::Compiled && rule.family != Family::Nothing) remember(at.thread.listRecords, rule, r);
    if (rule.family == Family::Draw) readState(at); // arrays are read from buffers at compile time
    if (!executes) return;
    const uint32_t list = std::exchange(at.thread.list, 0);
    gl(at, r);
    at.thread.list = list;
    at.thread.inPrimitive = false; // the list is one command
}

void GlStateTracker::lists(At& at, const Rule& rule, const RecordView& r) {
    const uint32_t first = argumentWord(r, 0), second = argumentWord(r, 1);
    std::vector<uint32_t> names;
    switch (rule.family) {
    case Family::GenLists: // range, result
        for (uint32_t i = 0; i < first && second != 0 && i < 1u << 20; ++i)
            (void)make(at, ObjectType::List, second + i);
        return;
    case Family::DeleteList:
        if (second > 1u << 20) return unknown(at, false);
        for (uint32_t i = 0; i < second; ++i) deleteOne(at, ObjectType::List, first + i);
        return;
    case Family::NewList: {
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
    case Family::EndList: {
        Object* const list = find(at, ObjectType::List, at.thread.list);
        at.thread.list = 0;
        if (list == nullptr) return;
        list->records = std::move(at.thread.listRecords);
        list->stacks = at.thread.listStacks;
        list->opaque = list->records.size() > kMaxListBytes;
        at.thread.listRecords.clear();
        return;
    }
    case Family::CallList: return callList(at, first);
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

} // namespace mural::trace
