#include "nodes/output/windows/window_owner.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "common/ipc/window_mark.hpp"

namespace mural {

namespace {

using namespace window_mark;

// Returns XCB_ATOM_NONE if `onlyIfExists` is set and the server has no such atom.
Result<xcb_atom_t> propertyOf(XConnection& x, uint32_t client, bool onlyIfExists, Deadline deadline) {
    const PropertyName name(client);
    const auto cookie = xcb_intern_atom(x.get(), onlyIfExists, name.length, name.text);
    XOwned<xcb_intern_atom_reply_t> atom;
    const XAnswer answer = x.await(cookie.sequence, deadline, &atom);
    if (answer == XAnswer::TimedOut || answer == XAnswer::ConnectionLost) {
        xcb_discard_reply(x.get(), cookie.sequence);
        return x.describe(answer);
    }
    return atom ? atom->atom : xcb_atom_t{XCB_ATOM_NONE};
}

bool names(std::span<const uint32_t> words, const WindowOwner& owner) {
    if (words.size() < kKeyWords) return false;
    const uint64_t key = uint64_t{words[1]} << 32 | words[0];
    const auto drawables = words.subspan(kKeyWords);
    return key == owner.sessionKey && std::ranges::find(drawables, owner.window) != drawables.end();
}

} // namespace

Result<void> WindowOwnerCheck::findProperty(XConnection& x, Deadline deadline) {
    auto found = propertyOf(x, owner_.client, true, deadline);
    if (!found) return found.error();
    property_ = *found;
    return {};
}

Result<WindowOwnerCheck::Owned> WindowOwnerCheck::owns(XConnection& x, xcb_window_t window, Deadline deadline) {
    if (property_ == XCB_ATOM_NONE) {
        if (auto found = findProperty(x, deadline); !found) return found.error();
        if (property_ == XCB_ATOM_NONE) return Owned::No;
    }
    const auto cookie = xcb_get_property(x.get(), 0, window, property_, XCB_ATOM_CARDINAL, 0, kMaxWords);
    XOwned<xcb_get_property_reply_t> mark;
    const XAnswer answer = x.await(cookie.sequence, deadline, &mark);
    if (answer == XAnswer::TimedOut || answer == XAnswer::ConnectionLost) {
        xcb_discard_reply(x.get(), cookie.sequence);
        return x.describe(answer);
    }
    if (!mark) return Owned::WindowGone;
    if (mark->format != 32) return Owned::No;
    const bool named =
        names({static_cast<const uint32_t*>(xcb_get_property_value(mark.get())), mark->value_len}, owner_);
    return named ? Owned::Yes : Owned::No;
}

Result<void> markWindow(XConnection& x, xcb_window_t window, const WindowOwner& owner, Deadline deadline) {
    auto property = propertyOf(x, owner.client, false, deadline);
    if (!property) return property.error();
    const std::array<uint32_t, kKeyWords + 1> words{static_cast<uint32_t>(owner.sessionKey),
                                                    static_cast<uint32_t>(owner.sessionKey >> 32), owner.window};
    xcb_change_property(x.get(), XCB_PROP_MODE_REPLACE, window, *property, XCB_ATOM_CARDINAL, 32, words.size(),
                        words.data());
    return {};
}

} // namespace mural
