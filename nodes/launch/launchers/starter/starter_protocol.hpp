// The messages between the head and a starter: lines of words. A starter reads its standard input and writes to its
// standard output. Pure.
//
//   head:     start ID HOST NAME ENDPOINT SECRET   sealed HOST CREDENTIAL   stop ID   alive
//   starter:  mural-starter VERSION BUILD HOST   started ID PID   says ID TEXT…   ended ID HOW…
//
// Several starters may read the same input; each obeys the lines with its host, or with "*".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "nodes/launch/launchers/launcher.hpp"

namespace mural::launch {

// To the starter.
struct StarterRequest {
    enum class Kind { Start, Sealed, Stop, Alive };
    Kind kind = Kind::Alive;
    int id = 0; // of a start, unique on its line
    std::string host = "*";
    std::string name, endpoint, secret; // Start
    std::string credential;             // Sealed: contains further lines
};

// To the head.
struct StarterReply {
    enum class Kind { Hello, Started, Says, Ended };
    Kind kind = Kind::Says;
    int id = 0;
    int pid = 0;                      // Started
    std::string version, build, host; // Hello
    std::string text;                 // Says; Ended: how
};

std::string lineOf(const StarterRequest& request); // without the newline
std::string lineOf(const StarterReply& reply);
// Return nothing for a line that is no message, such as a greeting of a login shell.
std::optional<StarterRequest> starterRequestOf(std::string_view line);
std::optional<StarterReply> starterReplyOf(std::string_view line);

} // namespace mural::launch
