// Tables of the program's contexts and windows, including destroyed ones whose end the nodes have not received. Memory
// of objects that both sides have released is reused. Programs that create and destroy objects in each frame do not
// grow.
#pragma once

#include <cstdint>

#include "interposer/context/context.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::known {

[[nodiscard]] inline bool nodesHave(const Context& c) { return c.announced && (!c.destroyed || c.freeDue); }
// Returns another context of the group that the nodes have; null: none.
const Context* sharerOf(const Context& c);
// Binds the context to these drawables (null: none) and releases the previous ones.
void retain(Context& c, Window* draw, Window* read);

// Returns a context that is current in no thread and was last bound to this window alone; null: none.
Context* idleContextOf(const Window& w);
// Returns whether the context is current in any thread.
bool isCurrent(const Context& c);
// Returns a context of the display that is not destroyed; null: none.
Context* contextOf(void* display);

// Return the next id whose destruction must be sent to the nodes now, each once. 0: no more.
uint32_t nextDueContext();
uint32_t nextDueWindow();
// The lock of all tables, held during a fork.
Lock& tables();
// For a forked child: marks all objects on the nodes as the parent's.
void inherit();
// Handles the destruction of an X window. Returns true if it has known drawables.
bool nativeEnds(uint64_t server, uint64_t native);
// Stores the ids of the drawables on an X window, up to `maximum`. Returns their number.
uint32_t drawablesOf(uint64_t server, uint64_t native, uint32_t* ids, uint32_t maximum);
// Returns whether the program draws into an X window of this number, on any server.
bool hasWindow(uint64_t native);
// Returns the plain X window of this number, for which the program has created no GLX drawable. Null: no memory.
//
// Mesa creates a drawable at the first binding, with the configuration of that context. It destroys the drawable when
// no context is bound to it or was last bound to it. The next binding creates another one, with the configuration of
// its context.
Window* bareWindow(uintptr_t drawable, void* display, const wire::WindowConfig& config);

} // namespace mural::known
