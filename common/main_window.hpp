// Which window the wall shows: the largest that has swapped; the first of equal ones stays. When it is
// destroyed, the largest of the others is the next.
#pragma once

#include <cstdint>
#include <map>

namespace mural {

class MainWindow {
public:
    // A window has swapped. Returns the number of this frame of the wall, from 1, which goes on over changes
    // of the window; 0 when it is not the main window's.
    int64_t swapped(uint32_t client, uint32_t window, uint32_t width, uint32_t height) {
        const Key key = keyOf(client, window);
        const uint64_t area = uint64_t{width} * height; // it may have been resized
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

    std::map<Key, uint64_t> areas_; // of the windows that have swapped, pixels
    Key main_ = 0;
    int64_t frames_ = 0;
};

} // namespace mural
