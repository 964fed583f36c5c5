#include "interposer/windows/shown.hpp"

#include "interposer/context.hpp"
#include "interposer/session.hpp"

namespace mural {

void waitWindowsShown() {
    if (Session* s = Session::current()) s->waitShown();
}

void waitGlShown() {
    Session* s = Session::current();
    if (!s || !s->alive()) return;
    flushedWindow(*tThread);
    s->waitShown();
}

} // namespace mural
