// Driver events: unrequested reports of the nodes' GL about the program's contexts. They are debug messages, out of
// memory and lost contexts. The program receives them at swaps, requests and glGetError.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>

#include "interposer/encode/session.hpp"

namespace mural {

struct Context;
struct DebugListener;
struct ThreadState;

// Passes the driver events of the thread's context to the program.
void deliverDriverEvents(ThreadState& t);
inline void takeDriverEvents(ThreadState& t) {
    const Session* s = Session::current();
    if (s && s->hasDriverEvents()) [[unlikely]]
        deliverDriverEvents(t);
}

// For a forked child: drops pending events, which concern the parent's contexts.
void forgetDriverEvents();

// The callback of glDebugMessageCallback; null: messages go to the driver's log.
void listen(Context& c, GLDEBUGPROC callback, const void* user);
// Ends the listener with its context: it passes on no more messages.
void forget(DebugListener& listener);
GLDEBUGPROC listener(const Context& c);
const void* listenersUser(const Context& c);

} // namespace mural
