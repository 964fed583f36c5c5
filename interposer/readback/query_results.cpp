#include "interposer/readback/query_results.hpp"

#include <cstdlib>

#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/context/thread_state.hpp"

namespace mural {

void QueryResults::begun(GLenum target, GLuint index, GLuint query) {
    if (ended_ && query < kNames) ended_[query] = {};
    Active* slot = nullptr;
    for (Active& a : active_) {
        if (a.query == 0 && !slot) slot = &a;
        if (a.query != 0 && a.target == target && a.index == index) return; // an error: a query is active already
    }
    if (slot) *slot = {target, index, query};
}

void QueryResults::ended(ThreadState& t, GLenum target, GLuint index, uint32_t swaps) {
    for (Active& a : active_) {
        if (a.query == 0 || a.target != target || a.index != index) continue;
        const GLuint query = a.query;
        a.query = 0;
        Session* const s = Session::current();
        if (query >= kNames || !s || !s->alive()) return;
        if (!ended_) ended_ = static_cast<Ended*>(std::calloc(kNames, sizeof(Ended)));
        if (!ended_) return;
        ended_[query] = {swaps + 1, readsLate_ ? s->nextAhead() : 0, 0, false};
        if (readsLate_) records::requestQuery(t, ended_[query].request, query, GL_QUERY_RESULT);
        return;
    }
}

bool QueryResults::find(GLuint query, uint32_t swaps, uint64_t& value) {
    if (!ended_ || query >= kNames || ended_[query].swaps == 0) return false;
    Ended& ended = ended_[query];
    readsLate_ = readsLate_ || ended.swaps != swaps + 1;
    Session* const s = Session::current();
    if (!ended.known && ended.request != 0 && ended.swaps != swaps + 1 && s)
        ended.known = s->prefetchedReply(ended.request, ended.value);
    if (ended.known) value = ended.value;
    return ended.known;
}

void QueryResults::keep(GLuint query, uint64_t value) {
    if (!ended_ || query >= kNames || ended_[query].swaps == 0) return;
    ended_[query].value = value;
    ended_[query].known = true;
}

} // namespace mural
