// Generated thunks (preload_thunks.cpp): one function per exported name, which jumps through its slot. The client
// defines resolveSlot, which finds the function of a name.
#pragma once

namespace mural {

using Entry = void (*)();

// Indexed by thunk; null: not resolved yet. Any thread may fill an entry at any time.
extern Entry gSlots[];
const char* thunkName(int number);
int thunkCount();

// Called at the first call of a name. Fills the slot, or leaves it empty to be called again. Never returns null.
Entry resolveSlot(int number);

} // namespace mural
