// The seat of a machine: its monitors and keyboards, and the user whose windows they show.
#pragma once

#include <string>

namespace mural::cli {

struct SeatFacts {
    std::string name; // "seat0"; empty: none
    std::string user; // of the active login; empty: nobody
    std::string type; // of the active login: "x11", "wayland", "tty"; empty: unknown
};

// Reads the state of logind, as sd_seat_get_active(3) does. folder: other than in tests /run/systemd.
SeatFacts readSeat(const std::string& folder = "/run/systemd");

// "seat0: alice, x11"
std::string textOf(const SeatFacts& seat);

} // namespace mural::cli
