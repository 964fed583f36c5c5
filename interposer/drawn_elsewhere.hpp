// Pictures that are drawn past us, all of them or in part. With no GL call through us: is the program's own
// context drawn into by another way, or has the program not drawn yet? With calls through us, which we do not
// let draw there: has something been drawn there all the same (local_pixels.hpp)?
#pragma once

namespace mural {

struct ThreadState;
struct Window;

// Called before and after records of our own are written: what lies between two is the program's.
void noteCalls(ThreadState& t);
void watchFromHere(ThreadState& t);
// Before a picture goes out. True: the context is used past us; this has been said, and the program is
// to go on alone.
bool drawnElsewhere(ThreadState& t, Window& w);

} // namespace mural
