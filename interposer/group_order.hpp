// The order of records among threads whose contexts share objects. One thread alone writes on a fast path, without the
// group's lock. From the second thread on every record takes the lock and publishes the records before it.
#pragma once

namespace mural {

struct Context;
class Session;
struct ThreadState;

namespace group_order {

// The thread makes the context current. Closes the fast path of the group's other threads when it is not alone.
void enter(ThreadState& t, Context& c);
// It gives the context up; under the group's lock. Its records are published.
void leave(ThreadState& t, Session* s);
// Before each record of a thread that is not alone: publishes what the others have completed. Returns with the group's
// lock held.
void takeTurn(ThreadState& t, Session& s);

} // namespace group_order

} // namespace mural
