#include "nodes/launch/launchers/starter/starter_protocol.hpp"

#include <charconv>
#include <vector>

namespace mural::launch {
namespace {

constexpr std::string_view kHello = "mural-starter";

// Removes and returns the first word.
std::string_view takeWord(std::string_view& line) {
    const size_t end = std::min(line.find(' '), line.size());
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    return word;
}

std::optional<int> idOf(std::string_view word) {
    int number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || number < 0) return {};
    return number;
}

} // namespace

std::string lineOf(const StarterRequest& r) {
    const std::string id = std::to_string(r.id);
    switch (r.kind) {
    case StarterRequest::Kind::Start:
        return "start " + id + " " + r.host + " " + r.name + " " + r.endpoint + " " + r.secret;
    case StarterRequest::Kind::Sealed: return "sealed " + r.host + " " + r.credential;
    case StarterRequest::Kind::Stop: return "stop " + id;
    case StarterRequest::Kind::Alive: break;
    }
    return "alive";
}

std::string lineOf(const StarterReply& r) {
    const std::string id = std::to_string(r.id);
    switch (r.kind) {
    case StarterReply::Kind::Hello: return std::string(kHello) + " " + r.version + " " + r.build + " " + r.host;
    case StarterReply::Kind::Started: return "started " + id + " " + std::to_string(r.pid);
    case StarterReply::Kind::Ended: return "ended " + id + " " + r.text;
    case StarterReply::Kind::Says: break;
    }
    return "says " + id + " " + r.text;
}

std::optional<StarterRequest> starterRequestOf(std::string_view line) {
    StarterRequest r;
    const std::string_view kind = takeWord(line);
    if (kind == "alive" && line.empty()) return r;
    if (kind == "sealed") {
        r.kind = StarterRequest::Kind::Sealed;
        r.host = takeWord(line);
        r.credential = takeWord(line);
        return r.host.empty() || r.credential.empty() || !line.empty() ? std::nullopt : std::optional(r);
    }
    if (kind != "start" && kind != "stop") return {};
    const auto id = idOf(takeWord(line));
    if (!id) return {};
    r.id = *id;
    r.kind = kind == "start" ? StarterRequest::Kind::Start : StarterRequest::Kind::Stop;
    if (r.kind == StarterRequest::Kind::Stop) return line.empty() ? std::optional(r) : std::nullopt;
    for (std::string* field : {&r.host, &r.name, &r.endpoint, &r.secret}) {
        *field = takeWord(line);
        if (field->empty()) return {};
    }
    return line.empty() ? std::optional(r) : std::nullopt;
}

std::optional<StarterReply> starterReplyOf(std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1); // a terminal
    StarterReply r;
    const std::string_view kind = takeWord(line);
    if (kind == kHello) {
        r.kind = StarterReply::Kind::Hello;
        for (std::string* field : {&r.version, &r.build, &r.host}) {
            *field = takeWord(line);
            if (field->empty()) return {};
        }
        return line.empty() ? std::optional(r) : std::nullopt;
    }
    if (kind != "started" && kind != "says" && kind != "ended") return {};
    const auto id = idOf(takeWord(line));
    if (!id) return {};
    r.id = *id;
    if (kind == "started") {
        const auto pid = idOf(line);
        if (!pid) return {};
        r.kind = StarterReply::Kind::Started;
        r.pid = *pid;
        return r;
    }
    r.kind = kind == "says" ? StarterReply::Kind::Says : StarterReply::Kind::Ended;
    r.text = line;
    return r;
}

} // namespace mural::launch
