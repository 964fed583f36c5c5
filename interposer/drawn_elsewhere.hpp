// Pictures that are shown without one GL call through us: is the program's own context drawn into by
// another way, or has the program not drawn yet?
#pragma once

namespace mural {

struct ThreadState;
struct Window;

// Called before and after records of our own are written: what lies between two is the program's.
void noteCalls(ThreadState& t);
void watchFromHere(ThreadState& t);
// Before a picture goes out. True: the context is used past us; this has been said, and the program is
// to go on alone.
bool drawnElsewhere(ThreadState& t, const Window& w);

} // namespace mural
