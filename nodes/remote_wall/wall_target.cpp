#include "nodes/remote_wall/wall_target.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

#include <fmt/format.h>

#include "nodes/frame_transfer/plane_codecs.hpp"
#include "nodes/remote_wall/wall_message.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::remote {

namespace {

constexpr size_t kMaxTargetName = 64;

bool isTargetName(const std::string& name) {
    return !name.empty() && name.size() <= kMaxTargetName && std::ranges::all_of(name, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
    });
}

Result<void> readInt(const std::string& name, const std::string& value, int lowest, int highest, int& into) {
    int number = 0;
    const char* const end = value.data() + value.size();
    const auto [stop, code] = std::from_chars(value.data(), end, number);
    if (code != std::errc() || stop != end || number < lowest || number > highest)
        return Error{fmt::format("{}={} must be a number from {} to {}", name, value, lowest, highest)};
    into = number;
    return {};
}

Result<void> readMember(const std::string& name, const std::string& value, WallTarget& target) {
    if (name == "codec") {
        if (auto known = wantedCodec(value); !known) return Error{"codec: " + known.error().message};
        target.codec = value;
        return {};
    }
    if (name == "tile") return readInt(name, value, kMinTile, kMaxTile, target.tile);
    if (name == "rate") return readInt(name, value, 1, kMaxRate, target.rate);
    if (name == "input") {
        const auto permission = input::inputPermissionOf(value);
        if (!permission) return Error{"input=" + value + " must be " + input::kInputPermissionNames};
        target.input = *permission;
        return {};
    }
    if (name == "secret" && !value.empty()) {
        target.secretFile = value;
        return {};
    }
    return Error{name == "secret" ? "secret= needs a file"
                                  : "unknown setting \"" + name + "\"; use codec, tile, rate, input or secret"};
}

Result<WallTarget> readTarget(const std::string& text) {
    const size_t comma = std::min(text.find(','), text.size());
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals > comma)
        return Error{"must be NAME=HOST:PORT, such as museum=wall.example:4281"};
    WallTarget target;
    target.name = text.substr(0, equals);
    if (!isTargetName(target.name))
        return Error{"the name must be 1 to 64 letters, digits, dots, hyphens or underscores"};
    const std::string place = text.substr(equals + 1, comma - equals - 1);
    const auto where = splitHostPort(place);
    if (!where || where->host.empty() || where->port == 0)
        return Error{"\"" + place + "\" must be HOST:PORT of mural show --listen, such as wall.example:4281"};
    target.host = where->host;
    target.port = where->port;
    for (size_t at = comma; at < text.size();) {
        const size_t end = std::min(text.find(',', at + 1), text.size());
        const std::string member = text.substr(at + 1, end - at - 1);
        const size_t middle = std::min(member.find('='), member.size());
        const std::string value = middle < member.size() ? member.substr(middle + 1) : "";
        if (auto read = readMember(member.substr(0, middle), value, target); !read) return read.error();
        at = end;
    }
    return target;
}

} // namespace

Result<WallTarget> wallTargetOf(const std::string& text) {
    auto target = readTarget(text);
    if (!target) return Error{"--send " + text + ": " + target.error().message};
    return target;
}

} // namespace mural::remote
