// Orders records among threads whose contexts share objects. A single thread writes on a fast path without the group's
// lock. From the second thread on, every record takes the lock and publishes the records before it.
#pragma once

namespace mural {

struct Context;
class Session;
struct ThreadState;

namespace group_order {

// Makes the context current in the thread. Closes the fast path of the group's other threads, if there are any.
void enter(ThreadState& t, Context& c);
// Releases the context and publishes the thread's records. Requires the group's lock.
void leave(ThreadState& t, Session* s);
// Call before each record of a thread that is not alone in its group. Publishes the completed records of the others.
// Returns with the group's lock held.
void takeTurn(ThreadState& t, Session& s);

} // namespace group_order

} // namespace mural
