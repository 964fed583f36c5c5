// Which window the wall shows: the largest that has swapped; the first of equal ones stays.
#pragma once

#include <cstdint>

namespace mural {

class MainWindow {
public:
    // A window has swapped. Returns the number of this frame of the main window, from 1; 0 when it is
    // another window's.
    int64_t swapped(uint32_t client, uint32_t window, uint32_t width, uint32_t height) {
        const uint64_t area = uint64_t{width} * height;
        const bool same = frames_ > 0 && client == client_ && window == window_;
        if (!same) {
            if (area <= area_) return 0;
            client_ = client;
            window_ = window;
            frames_ = 0;
        }
        area_ = area; // it may have been resized
        return ++frames_;
    }

    // Its program has ended: the next window that swaps is the main one.
    void clientGone(uint32_t client) {
        if (client != client_) return;
        area_ = 0;
        frames_ = 0;
    }

private:
    uint32_t client_ = 0;
    uint32_t window_ = 0;
    uint64_t area_ = 0;
    int64_t frames_ = 0;
};

} // namespace mural
