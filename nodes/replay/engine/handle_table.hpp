// Maps the program's bindless texture and image handles (ARB_bindless_texture) to this node's. They are mostly equal:
// drivers number handles in request order, and nodes repeat the program's order. Texture and image handles are
// separate: a number may be both.
#pragma once

#include <cstdint>
#include <unordered_map>

namespace mural {

class HandleTable {
public:
    enum class Of : uint8_t { Texture, Image };

    // Records that this node's driver returned `nodeHandle` for the program's `appHandle`. Replaces an older pair:
    // handles end with their textures, and drivers reuse them. Returns false if the two differ for the first time.
    bool set(Of of, uint64_t appHandle, uint64_t nodeHandle) {
        table(of)[appHandle] = nodeHandle;
        const bool fresh = appHandle != nodeHandle && !differ_;
        differ_ = differ_ || appHandle != nodeHandle;
        return !fresh;
    }
    // 0: unknown handle.
    [[nodiscard]] uint64_t find(Of of, uint64_t appHandle) const {
        const auto& known = of == Of::Texture ? textures_ : images_;
        const auto it = known.find(appHandle);
        return it == known.end() ? 0 : it->second;
    }
    // For a number that may be a handle: returns it unchanged if it is none. `first`: the more likely kind.
    [[nodiscard]] uint64_t value(Of first, uint64_t appHandle) const {
        if (!differ_) return appHandle;
        if (const uint64_t nodeHandle = find(first, appHandle)) return nodeHandle;
        const uint64_t other = find(first == Of::Texture ? Of::Image : Of::Texture, appHandle);
        return other ? other : appHandle;
    }
    [[nodiscard]] bool differ() const { return differ_; } // some pair has differed

private:
    std::unordered_map<uint64_t, uint64_t>& table(Of of) { return of == Of::Texture ? textures_ : images_; }
    std::unordered_map<uint64_t, uint64_t> textures_, images_;
    bool differ_ = false;
};

} // namespace mural
