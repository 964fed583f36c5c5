// All contexts and windows that the program has, and those that the nodes still have to be told the end of. What both
// have given up lends its memory to the next one: programs that make and destroy them in each frame don't grow.
#pragma once

#include <cstdint>

#include "interposer/context.hpp"

namespace mural::known {

[[nodiscard]] inline bool nodesHave(const Context& c) { return c.announced && (!c.destroyed || c.freeDue); }
// Another context of its group that the nodes have; null: there is none.
const Context* sharerOf(const Context& c);
// The context is bound to these drawables (null: none), and no longer to those before.
void hold(Context& c, Window* draw, Window* read);

// A context that is current nowhere and was bound to this window alone last; null: there is none.
Context* idleHolderOf(const Window& w);
// In any thread.
bool isCurrent(const Context& c);
// One that is not destroyed; null: none.
Context* contextOf(void* display);

// Ids that the nodes are told the end of now, each once; 0: no more.
uint32_t nextDueContext();
uint32_t nextDueWindow();
// Of all tables; for the time of a fork.
Lock& tables();
// For a forked child: what the nodes know is the parent's.
void inherit();
// An X window is destroyed. True: drawables of it are known.
bool nativeEnds(uint64_t server, uint64_t native);
// Ids of the drawables on an X window, up to `most`. Returns how many there are.
uint32_t drawablesOf(uint64_t server, uint64_t native, uint32_t* ids, uint32_t most);
// The plain X window of this number, which GLX takes without making a drawable of it. Mesa makes one at the first
// binding, with the configuration of that context, and destroys it when no context is bound to it or was bound to
// it last. The next binding makes another one, with the configuration of its context. Null: no memory.
Window* bareWindow(uintptr_t drawable, void* display, const wire::WindowConfig& config);

} // namespace mural::known
