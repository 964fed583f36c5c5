#include "interposer/x11/introduction.hpp"

#include <X11/Xlib.h>
#include <cstdlib>
#include <xcb/xcb.h>

#include "common/ipc/window_mark.hpp"
#include "interposer/context/context.hpp"
#include "interposer/entry/egl_displays.hpp"
#include "interposer/entry/xlib.hpp"
#include "interposer/context/object_registry.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/x11/next_function.hpp"
#include "interposer/x11/x_server.hpp"

namespace mural {

namespace {

constexpr ::Atom kCardinal = 6; // XA_CARDINAL
constexpr size_t kNameBytes = 128;

struct Mark {
    window_mark::PropertyName property;
    uint32_t words[window_mark::kMaxWords];
    uint32_t count;
};

Mark markOf(const Window& w, const Session& s) {
    Mark mark{window_mark::PropertyName(s.welcome().clientId), {}, window_mark::kKeyWords};
    const uint64_t key = s.nameKey();
    mark.words[0] = static_cast<uint32_t>(key);
    mark.words[1] = static_cast<uint32_t>(key >> 32);
    mark.count +=
        known::drawablesOf(w.server, w.native, mark.words + window_mark::kKeyWords, window_mark::kMaxDrawables);
    return mark;
}

void describe(Window& w, Session& s, int socket, const char* name) {
    char made[kNameBytes] = "";
    w.server = serverOf(socket);
    if (!name && displayNameOf(socket, made, sizeof made)) name = made;
    w.config.nativeHigh = s.displayNumber(name ? name : "");
}

void introduceByXlib(Window& w, Session& s, Display* dpy) {
    static auto* socket = xlib<int(Display*)>("XConnectionNumber");
    static auto* name = xlib<char*(Display*)>("XDisplayString");
    static auto* intern = xlib<::Atom(Display*, const char*, Bool)>("XInternAtom");
    static auto* change =
        xlib<int(Display*, ::Window, ::Atom, ::Atom, int, int, const unsigned char*, int)>("XChangeProperty");
    if (!socket || !name || !intern || !change) return;
    describe(w, s, socket(dpy), name(dpy));
    if (!s.welcome().displayApp) return;
    const Mark mark = markOf(w, s);
    unsigned long words[window_mark::kMaxWords]; // Xlib's form of 32 bits
    for (uint32_t i = 0; i < mark.count; ++i) words[i] = mark.words[i];
    change(dpy, w.native, intern(dpy, mark.property.text, False), kCardinal, 32, PropModeReplace,
           reinterpret_cast<const unsigned char*>(words), static_cast<int>(mark.count));
}

// Functions of the libxcb that the program's EGL has loaded.
struct Xcb {
    template <class F> static F* get(const char* name) { return loadedFunction<F>(kXcb, name); }
    decltype(&xcb_connect) connect = get<decltype(xcb_connect)>("xcb_connect");
    decltype(&xcb_connection_has_error) hasError = get<decltype(xcb_connection_has_error)>("xcb_connection_has_error");
    decltype(&xcb_disconnect) disconnect = get<decltype(xcb_disconnect)>("xcb_disconnect");
    decltype(&xcb_get_file_descriptor) socket = get<decltype(xcb_get_file_descriptor)>("xcb_get_file_descriptor");
    decltype(&xcb_intern_atom) intern = get<decltype(xcb_intern_atom)>("xcb_intern_atom");
    decltype(&xcb_intern_atom_reply) interned = get<decltype(xcb_intern_atom_reply)>("xcb_intern_atom_reply");
    decltype(&xcb_change_property_checked) change =
        get<decltype(xcb_change_property_checked)>("xcb_change_property_checked");
    decltype(&xcb_request_check) check = get<decltype(xcb_request_check)>("xcb_request_check");
    [[nodiscard]] bool complete() const {
        return connect && hasError && disconnect && socket && intern && interned && change && check;
    }
};

// Returns false if the server has no such window.
bool putMark(const Xcb& xcb, xcb_connection_t* c, const Window& w, const Mark& mark) {
    xcb_intern_atom_reply_t* atom =
        xcb.interned(c, xcb.intern(c, 0, mark.property.length, mark.property.text), nullptr);
    if (!atom) return true;
    const auto request = xcb.change(c, XCB_PROP_MODE_REPLACE, static_cast<xcb_window_t>(w.native), atom->atom,
                                    XCB_ATOM_CARDINAL, 32, mark.count, mark.words);
    std::free(atom);
    xcb_generic_error_t* error = xcb.check(c, request);
    const bool found = !error;
    std::free(error);
    return found;
}

// The driver alone knows the connection of EGL_DEFAULT_DISPLAY. This function therefore opens a temporary connection.
// A number without an X window belongs to another platform of EGL.
void introduceByXcb(Window& w, Session& s) {
    static const Xcb xcb;
    if (!xcb.complete()) return;
    xcb_connection_t* known = xConnectionOf(w.display);
    xcb_connection_t* c = known ? known : xcb.connect(nullptr, nullptr);
    const bool usable = !xcb.hasError(c);
    if (usable) {
        describe(w, s, xcb.socket(c), nullptr);
        if ((s.welcome().displayApp || !known) && !putMark(xcb, c, w, markOf(w, s))) w.config.nativeLow = 0;
    }
    if (!known) xcb.disconnect(c);
}

} // namespace

void introduceWindow(Window& w) {
    Session* s = Session::current();
    if (w.introduced || w.nativeGone || !w.native || !s || !s->alive()) return;
    w.introduced = true;
    if (w.isEgl)
        introduceByXcb(w, *s);
    else
        introduceByXlib(w, *s, static_cast<Display*>(w.display));
}

} // namespace mural
