// The thunks are generated (front_thunks.cpp): one function for each exported name, which jumps through
// its slot. Who links them says by resolveSlot what stands behind a name.
#pragma once

namespace mural {

using Entry = void (*)();

// By number of the thunk; null: not asked for yet. May be filled at any time, by any thread.
extern Entry gSlots[];
const char* thunkName(int number);
int thunkCount();

// Called at a name's first call; fills the slot, or leaves it empty to be asked again. Never null.
Entry resolveSlot(int number);

} // namespace mural
