// How an object travels from its writer to its readers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mural {

// The parts of an object that a commit sends, and the lifetime of older versions.
enum class Sharing : uint8_t {
    Static,     // one version, sent once
    Instance,   // all fields with every commit; versions of frames in progress stay available
    Delta,      // changed fields only; versions of frames in progress stay available
    Unbuffered, // all fields with every commit; only the newest version is kept, so frames may see a newer one
};

// When readers receive an object.
enum class Delivery : uint8_t {
    Push,     // every reader, with the commit
    OnDemand, // readers that request it; simultaneous requests of several readers are answered by one multicast
};

struct ShareOptions {
    Sharing sharing = Sharing::Delta;
    Delivery delivery = Delivery::Push;
    // Number of older versions that stay available; the versions of frames in progress always do.
    uint32_t keptVersions = 0;
    // Largest number of commits that a reader may lag behind before commit() waits. 0: no limit of its own; the frame
    // credit bounds the lag.
    uint32_t mostUnread = 0;
    // Name for lookups and messages, at most 255 bytes.
    std::string name = {};
};

namespace native {

// Begins the name of the object behind a state. Objects of Session::share() have other names. Internal.
inline constexpr std::string_view kStatePrefix = ":state ";
// The name of the object behind a state of this name. Internal.
[[nodiscard]] inline std::string stateName(std::string_view name) {
    return std::string(kStatePrefix) + std::string(name);
}

} // namespace native

} // namespace mural
