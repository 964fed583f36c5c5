// Selects the window that the wall shows: the largest that has swapped, the first of equal ones. After its destruction
// the largest remaining window follows.
#pragma once

#include <cstdint>
#include <map>

namespace mural {

class MainWindow {
public:
    // Reports a swap. Returns the wall's frame number, from 1, which continues across changes of the window; 0 for
    // other windows.
    int64_t swapped(uint32_t client, uint32_t window, uint32_t width, uint32_t height) {
        const Key key = keyOf(client, window);
        const uint64_t area = uint64_t{width} * height; // the window may have been resized
        areas_[key] = area;
        const auto now = areas_.find(main_);
        if (key != main_ && now != areas_.end() && area <= now->second) return 0;
        main_ = key;
        return ++frames_;
    }

    void windowGone(uint32_t client, uint32_t window) {
        areas_.erase(keyOf(client, window));
        chooseAgain();
    }
    void clientGone(uint32_t client) {
        areas_.erase(areas_.lower_bound(keyOf(client, 0)), areas_.upper_bound(keyOf(client, UINT32_MAX)));
        chooseAgain();
    }

private:
    using Key = uint64_t; // client, window
    static Key keyOf(uint32_t client, uint32_t window) { return uint64_t{client} << 32 | window; }

    void chooseAgain() {
        if (areas_.contains(main_)) return;
        main_ = 0;
        uint64_t largest = 0;
        for (const auto& [key, area] : areas_) {
            if (area <= largest) continue;
            largest = area;
            main_ = key;
        }
    }

    std::map<Key, uint64_t> areas_; // areas of swapped windows, in pixels
    Key main_ = 0;
    int64_t frames_ = 0;
};

} // namespace mural
