// A value of --send: a remote wall, and how pictures go there. Pure.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.hpp"
#include "nodes/input/input_permission.hpp"

namespace mural::remote {

struct WallTarget {
    std::string name;
    std::string host;
    uint16_t port = 0;
    std::string codec = "jpeg-100";
    int tile = 512;
    int rate = 60; // most frames per second
    input::InputPermission input = input::InputPermission::Off;
    std::string secretFile; // empty: that of --secret
};

// "museum=wall.example:4281,codec=auto,tile=256,rate=30,input=on,secret=FILE". Errors: one line for the user.
Result<WallTarget> wallTargetOf(const std::string& text);

} // namespace mural::remote
