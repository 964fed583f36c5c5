// A window manager for a private display of the wall's size: the program's main window fills the
// screen exactly, before it is first seen; all other windows get what they ask for.
//
// The main window is the first mapped top-level window that is neither transient nor of a helper kind
// (dialog, menu, splash, …); when it goes, the next such window takes its place. Windows with
// override-redirect never come here, by the protocol.
//
// Owned by one thread, which calls dispatch() whenever fd() is readable.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <xcb/xcb.h>

#include "common/result.hpp"
#include "nodes/launch/x_authority.hpp"

namespace mural::launch {

class WallWindowManager {
public:
    // Fails when another window manager has the display.
    static Result<std::unique_ptr<WallWindowManager>>
    open(const std::string& display, const XAuthority::Cookie& cookie, int width, int height);
    WallWindowManager(const WallWindowManager&) = delete;
    WallWindowManager& operator=(const WallWindowManager&) = delete;
    ~WallWindowManager();

    [[nodiscard]] int fd() const;
    // Handles all that has arrived; false when the display is gone.
    bool dispatch();
    [[nodiscard]] xcb_window_t mainWindow() const { return main_; }

private:
    WallWindowManager(xcb_connection_t* connection, int width, int height);
    bool takeRoot();
    void handle(const xcb_generic_event_t& event);
    void mapRequested(const xcb_map_request_event_t& event);
    void configureRequested(const xcb_configure_request_event_t& event);
    void windowGone(xcb_window_t window);
    void fillScreen(xcb_window_t window);
    void tellGeometry(xcb_window_t window);
    void setState(xcb_window_t window, uint32_t state);
    [[nodiscard]] bool canBeMain(xcb_window_t window);
    [[nodiscard]] bool isHelperKind(xcb_window_t window);
    xcb_atom_t atom(const char* name);

    xcb_connection_t* connection_;
    xcb_window_t root_ = XCB_NONE;
    int width_;
    int height_;
    xcb_window_t main_ = XCB_NONE;
    std::vector<xcb_window_t> waiting_; // mapped later than the main one, could follow it
    xcb_atom_t wmState_ = XCB_NONE;
    xcb_atom_t windowType_ = XCB_NONE;
    std::vector<xcb_atom_t> mainKinds_; // values of _NET_WM_WINDOW_TYPE that a main window may have
};

} // namespace mural::launch
