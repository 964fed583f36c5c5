// Selects the window that the wall shows: the largest that has swapped, the first of equal ones. After its destruction
// the largest remaining window follows. Several drawables on one X window are one window: the last swap decides.
#pragma once

#include <cstdint>
#include <map>

namespace mural {

class MainWindow {
public:
    // Reports a swap. Returns the wall's frame number, from 1, which continues across changes of the window; 0 for
    // other windows. native: the X window, 0 for none.
    int64_t swapped(uint32_t client, uint32_t window, uint32_t width, uint32_t height, uint64_t native = 0) {
        const Key key = keyOf(client, window);
        const uint64_t area = uint64_t{width} * height; // the window may have been resized
        windows_[key] = {area, client, native};
        const auto now = windows_.find(main_);
        const bool same =
            now != windows_.end() && native != 0 && now->second.native == native && now->second.client == client;
        if (key != main_ && !same && now != windows_.end() && area <= now->second.area) return 0;
        main_ = key;
        return ++frames_;
    }

    void windowGone(uint32_t client, uint32_t window) {
        windows_.erase(keyOf(client, window));
        chooseAgain();
    }
    void clientGone(uint32_t client) {
        windows_.erase(windows_.lower_bound(keyOf(client, 0)), windows_.upper_bound(keyOf(client, UINT32_MAX)));
        chooseAgain();
    }

private:
    using Key = uint64_t; // client, window
    static Key keyOf(uint32_t client, uint32_t window) { return uint64_t{client} << 32 | window; }

    void chooseAgain() {
        if (windows_.contains(main_)) return;
        main_ = 0;
        uint64_t largest = 0;
        for (const auto& [key, window] : windows_) {
            if (window.area <= largest) continue;
            largest = window.area;
            main_ = key;
        }
    }

    struct Window {
        uint64_t area = 0; // in pixels
        uint32_t client = 0;
        uint64_t native = 0;
    };
    std::map<Key, Window> windows_; // windows that have swapped
    Key main_ = 0;
    int64_t frames_ = 0;
};

} // namespace mural
