#include "tools/mural/hosts/seat_facts.hpp"

#include <cstdlib>
#include <fstream>
#include <map>
#include <pwd.h>

namespace mural::cli {

namespace {

// Lines NAME=VALUE.
std::map<std::string, std::string> valuesIn(const std::string& path) {
    std::map<std::string, std::string> values;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);)
        if (const size_t at = line.find('='); at != std::string::npos) values[line.substr(0, at)] = line.substr(at + 1);
    return values;
}

std::string nameOfUser(const std::string& uid) {
    if (uid.empty()) return {};
    const passwd* user = getpwuid(static_cast<uid_t>(std::strtoul(uid.c_str(), nullptr, 10)));
    return user != nullptr ? user->pw_name : uid;
}

} // namespace

SeatFacts readSeat(const std::string& folder) {
    SeatFacts seat;
    auto values = valuesIn(folder + "/seats/seat0");
    if (values.empty()) return seat;
    seat.name = "seat0";
    seat.user = nameOfUser(values["ACTIVE_UID"]);
    if (!values["ACTIVE"].empty()) seat.type = valuesIn(folder + "/sessions/" + values["ACTIVE"])["TYPE"];
    return seat;
}

std::string textOf(const SeatFacts& seat) {
    if (seat.name.empty()) return "none";
    if (seat.user.empty()) return seat.name + ": nobody is logged in";
    return seat.name + ": " + seat.user + (seat.type.empty() ? "" : ", " + seat.type);
}

} // namespace mural::cli
