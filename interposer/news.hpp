// What the nodes' GL tells of the program's contexts without having been asked: driver messages, memory
// that could not be had, contexts that are lost. Taken at swaps, questions and glGetError.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>

#include "interposer/session.hpp"

namespace mural {

struct Context;
struct DebugListener;
struct ThreadState;

// Hands the program what concerns the thread's context.
void takeWaitingNews(ThreadState& t);
inline void takeNews(ThreadState& t) {
    const Session* s = Session::current();
    if (s && s->newsWaiting()) [[unlikely]] takeWaitingNews(t);
}

// For a forked child: they are for its parent's contexts.
void forgetNews();

// The callback of glDebugMessageCallback; null: messages go to the driver's log.
void listen(Context& c, GLDEBUGPROC callback, const void* user);
// Its context is gone: it tells nobody.
void forget(DebugListener& listener);
GLDEBUGPROC listener(const Context& c);
const void* listenersUser(const Context& c);

} // namespace mural
