// A window manager for a private display of the wall's size. The program's main window fills the screen before it
// becomes visible; all other windows keep their requested geometry.
//
// The main window is the first mapped top-level window that is neither transient nor auxiliary (dialog, menu, splash,
// …). When it closes, the next such window replaces it. Override-redirect windows bypass window managers.
//
// Owned by one thread, which calls dispatch() whenever fd() is readable.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <xcb/xcb.h>

#include "common/base/result.hpp"
#include "nodes/launch/x_authority.hpp"

namespace mural::launch {

class WallWindowManager {
public:
    // Fails if the display has another window manager.
    static Result<std::unique_ptr<WallWindowManager>> open(const std::string& display, const XAuthority::Cookie& cookie,
                                                           int width, int height);
    WallWindowManager(const WallWindowManager&) = delete;
    WallWindowManager& operator=(const WallWindowManager&) = delete;
    ~WallWindowManager();

    [[nodiscard]] int fd() const;
    // Processes all pending events. Returns false if the display is lost.
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
    void sendGeometry(xcb_window_t window);
    void setState(xcb_window_t window, uint32_t state);
    [[nodiscard]] bool canBeMain(xcb_window_t window);
    [[nodiscard]] bool isHelperKind(xcb_window_t window);
    xcb_atom_t atom(const char* name);

    xcb_connection_t* connection_;
    xcb_window_t root_ = XCB_NONE;
    int width_;
    int height_;
    xcb_window_t main_ = XCB_NONE;
    std::vector<xcb_window_t> waiting_; // candidates to replace the main window
    xcb_atom_t wmState_ = XCB_NONE;
    xcb_atom_t windowType_ = XCB_NONE;
    std::vector<xcb_atom_t> mainKinds_; // values of _NET_WM_WINDOW_TYPE allowed for a main window
};

} // namespace mural::launch
