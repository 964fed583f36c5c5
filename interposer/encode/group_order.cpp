#include "interposer/encode/group_order.hpp"

#include "interposer/context/context.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/context/thread_state.hpp"

namespace mural::group_order {

namespace {

template <class Visit> void forOthers(const ThreadState& t, const ShareGroup& group, Visit&& visit) {
    for (ThreadState* other = firstThread(); other; other = other->next)
        if (other != &t && other->context && other->context->group == &group) visit(*other);
}

// Closes the fast path of another thread without waiting for it. That thread may have read its limit earlier and may be
// writing a record. Such a record is concurrent to this call, but not to later commands that the program orders after
// it. Its records are therefore published before each record of other threads, until it takes its own turn. A barrier
// (membarrier) would not avoid this, and sandboxes may kill a program for it.
void closeFastPath(ThreadState& other) {
    if (other.shared) return;
    other.shared = true;
    other.mayBeWriting = true;
    ++other.context->group->unsettledThreads;
    __atomic_store_n(&other.limit, nullptr, __ATOMIC_SEQ_CST);
}

void settle(ThreadState& t) {
    if (!t.mayBeWriting) return;
    t.mayBeWriting = false;
    --t.context->group->unsettledThreads;
}

void publishUnsettled(const ThreadState& t, Session& s, const ShareGroup& group) {
    forOthers(t, group, [&](ThreadState& other) {
        if (other.mayBeWriting) s.publish(other, false, false);
    });
}

} // namespace

void enter(ThreadState& t, Context& c) {
    ShareGroup& group = *c.group;
    Guard guard(group.lock);
    ++group.threads;
    t.context = &c;
    t.shared = group.threads > 1;
    if (!t.shared) return;
    forOthers(t, group, closeFastPath);
    if (Session* s = Session::current()) forOthers(t, group, [&](ThreadState& other) { s->publish(other, false); });
}

void leave(ThreadState& t, Session* s) {
    ShareGroup& group = *t.context->group;
    if (s && s->alive()) s->publish(t, false);
    settle(t);
    --group.threads;
    if (group.lastWriter == &t) group.lastWriter = nullptr;
    t.shared = false;
    t.context = nullptr;
}

void takeTurn(ThreadState& t, Session& s) {
    ShareGroup& group = *t.context->group;
    group.lock.lock();
    settle(t);
    if (group.unsettledThreads > 0) [[unlikely]]
        publishUnsettled(t, s, group);
    if (group.lastWriter && group.lastWriter != &t) s.publish(*group.lastWriter, false);
    group.lastWriter = &t;
    t.locked = true;
}

} // namespace mural::group_order
