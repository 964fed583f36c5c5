// State of a forked child. It drops everything that belongs to the parent's stream. Contexts that the nodes have draw
// locally in the child. A context that the child creates connects to the head anew, as a separate program.
#pragma once

namespace mural {

struct Window;

// Call after the process has connected. Its forked children then start with clean state.
void expectForks();

// Call when the child makes one of its parent's contexts current, or shows its picture. Reports once that the wall
// lacks that picture.
void inheritedUsed(Window* window);

} // namespace mural
