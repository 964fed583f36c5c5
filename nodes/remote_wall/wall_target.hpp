// A value of --send: a remote wall, and how pictures go there. Pure.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.hpp"

namespace mural::remote {

// Whether events of the remote wall's windows reach the program.
enum class InputFrom : uint8_t {
    Off,
    Private, // if the program runs on a private display
    Any      // also on a display of the user, whose pointer then moves
};

struct WallTarget {
    std::string name;
    std::string host;
    uint16_t port = 0;
    std::string codec = "jpeg-100";
    int tile = 512;
    int rate = 60; // most frames per second
    InputFrom input = InputFrom::Off;
    std::string secretFile; // empty: that of --secret
};

// "museum=wall.example:4281,codec=auto,tile=256,rate=30,input=on,secret=FILE". Errors: one line for the user.
Result<WallTarget> wallTargetOf(const std::string& text);

} // namespace mural::remote
