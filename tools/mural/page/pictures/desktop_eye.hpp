// The contents of an X display as one picture. XDamage tells which part has changed, so an unchanged display costs
// nothing. Blocks while the X server does not answer. Used by one thread.
#pragma once

#include <cstdint>
#include <memory>

#include <xcb/xcb.h>

#include "common/base/result.hpp"
#include "nodes/input/program_display.hpp"
#include "nodes/input/x_display.hpp"
#include "nodes/output/picture.hpp"

namespace mural::page {

class DesktopEye {
public:
    // Errors: the display cannot be opened, has no DAMAGE extension, or no pixels of 32 bits.
    static Result<std::unique_ptr<DesktopEye>> open(const input::ProgramDisplay& display);

    // Reads the part that has changed. Returns whether there was one.
    bool look();
    [[nodiscard]] Picture picture() const { return picture_.view(); }
    [[nodiscard]] bool isLost() const;
    // Descriptor of the connection, whose shutdown ends a blocked call.
    [[nodiscard]] int fd() const { return xcb_get_file_descriptor(connection_.get()); }

private:
    struct Box { // pixels from the upper left corner; the ends are excluded
        int left = 0, top = 0, right = 0, bottom = 0;
        [[nodiscard]] bool empty() const { return left >= right || top >= bottom; }
    };

    explicit DesktopEye(input::XConnection connection) : connection_(std::move(connection)) {}
    Result<void> begin();
    void takeEvents();
    bool read(const Box& box);

    input::XConnection connection_;
    xcb_window_t root_ = 0;
    uint32_t damage_ = 0;
    uint8_t firstEvent_ = 0;
    Box changed_; // not yet read
    OwnedPicture picture_;
};

} // namespace mural::page
