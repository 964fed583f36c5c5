// Display lists: nothing is deferred during compilation, and calling a list that binds something disables deferral.
#include <GL/gl.h>
#include <GL/glext.h>

#include "streamcodec/filter/command_filter.hpp"
#include "streamcodec/effect_rules.hpp"

namespace mural::filter {

using wire::argumentWord;

void CommandFilter::list(At& at) {
    Stream& stream = at.stream;
    const uint32_t first = argumentWord(at.r, 0);
    switch (at.kind.effect) {
    case EffectKind::NewList:
        if (stream.inPrimitive || stream.list != 0) return; // an error
        releaseGroup(stream, at.output, at.from);
        if (argumentWord(at.r, 1) != GL_COMPILE) return untrack(at);
        stream.list = first;
        stream.compiled = {};
        stream.depth = 0;
        return;
    case EffectKind::EndList:
        if (stream.list == 0) return;
        stream.compiled.binds = stream.compiled.binds || stream.depth != 0;
        at.group.lists[stream.list] = stream.compiled;
        at.group.listsBind = at.group.listsBind || stream.compiled.binds;
        stream.list = 0;
        return;
    default: break;
    }
    if (stream.list != 0) {
        stream.compiled.calls = true;
        return;
    }
    bool binds = false, calls = at.kind.effect != EffectKind::CallList;
    if (!calls) {
        const auto found = at.group.lists.find(first);
        if (found != at.group.lists.end()) binds = found->second.binds, calls = found->second.calls;
    }
    if (calls) binds = at.group.listsBind; // the called lists are not tracked
    if (binds) return untrack(at);
    if (!stream.inPrimitive) use(at);
}

// Handles a command during list compilation: part of the list, or executed immediately.
void CommandFilter::compiled(At& at) {
    switch (at.kind.about) {
    case CommandClass::Begin: ++at.stream.depth; return;
    case CommandClass::End: --at.stream.depth; return;
    case CommandClass::Use:
    case CommandClass::Arrays: return;
    case CommandClass::Bind: break;
    case CommandClass::Unknown:
        if (at.kind.effect == EffectKind::Handle) return untrack(at); // not part of lists: executed immediately
        at.stream.compiled.binds = true;
        return;
    case CommandClass::Upload:
    case CommandClass::Object: // buffer commands are not part of lists
        if (Object* const object = objectOf(at); object != nullptr && object->kind == Kind::Buffer)
            return object->known.clear();
        [[fallthrough]];
    default: at.stream.compiled.binds = true; return;
    }
    switch (at.kind.effect) {
    case EffectKind::Gen: // not part of lists
    case EffectKind::Create:
    case EffectKind::Delete:
    case EffectKind::ProgramDelete:
    case EffectKind::ArrayPointer:
    case EffectKind::ArraySet:
    case EffectKind::ClientActiveTexture:
    case EffectKind::ClientPush:
    case EffectKind::ClientPop: return bind(at);
    case EffectKind::Cap:
        at.stream.compiled.binds = at.stream.compiled.binds || isDebugOutput(argumentWord(at.r, 0));
        return;
    case EffectKind::Bind:
        if (at.kind.binding == Binding::Buffer || at.kind.binding == Binding::VertexArray) return bind(at);
        [[fallthrough]];
    default: at.stream.compiled.binds = true;
    }
}

} // namespace mural::filter
