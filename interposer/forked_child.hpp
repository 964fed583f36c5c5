// What a forked child keeps of its parent: nothing that is in the parent's stream. Contexts that the nodes know draw on
// their own in the child; a context that the child makes connects to the head anew, as a program of its own.
#pragma once

namespace mural {

struct Window;

// After the process has connected: its children begin as such.
void expectForks();

// The child makes one of its parent's contexts current, or shows a picture of it: says once that the wall lacks it.
void inheritedUsed(Window* window);

} // namespace mural
