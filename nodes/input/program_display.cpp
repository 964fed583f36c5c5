#include "nodes/input/program_display.hpp"

#include <fstream>
#include <iterator>

namespace mural::input {

Result<ProgramDisplay> programDisplay(pid_t program, pid_t runPid, std::string name, uint32_t window) {
    std::ifstream file("/proc/" + std::to_string(program) + "/environ", std::ios::binary);
    const std::string environment{std::istreambuf_iterator<char>(file), {}};
    ProgramDisplay display;
    display.name = name.empty() ? variableIn(environment, "DISPLAY") : std::move(name);
    if (display.name.empty()) return Error{"the program has no X display"};
    display.authority = variableIn(environment, "XAUTHORITY");
    display.isPrivate = display.authority.starts_with("/proc/" + std::to_string(runPid) + "/fd/");
    display.window = window;
    return display;
}

std::string variableIn(std::string_view environment, std::string_view name) {
    while (!environment.empty()) {
        const size_t end = environment.find('\0');
        const std::string_view entry = environment.substr(0, end);
        if (entry.size() > name.size() && entry.starts_with(name) && entry[name.size()] == '=')
            return std::string(entry.substr(name.size() + 1));
        if (end == std::string_view::npos) break;
        environment.remove_prefix(end + 1);
    }
    return {};
}

// Source: Xau.h of libXau: family, then address, number, name and data, each with its length, big-endian.
std::string cookieIn(std::string_view bytes) {
    std::string cookie;
    const auto number = [&](size_t at) {
        return (static_cast<size_t>(static_cast<unsigned char>(bytes[at])) << 8) |
               static_cast<unsigned char>(bytes[at + 1]);
    };
    size_t at = 0;
    while (at + 2 <= bytes.size()) {
        at += 2; // family
        std::string_view part;
        for (int field = 0; field < 4; ++field) {
            if (at + 2 > bytes.size() || at + 2 + number(at) > bytes.size()) return cookie;
            part = bytes.substr(at + 2, number(at));
            at += 2 + part.size();
        }
        cookie = std::string(part);
    }
    return cookie;
}

} // namespace mural::input
