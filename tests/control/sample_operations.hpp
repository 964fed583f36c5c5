// Operations without a session, and the lines that a protocol has written.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/json/json_text.hpp"
#include "nodes/head/control/control_protocol.hpp"

namespace mural {

inline ControlOperations sampleOperations() {
    using Kind = ControlArgument::Kind;
    using nlohmann::json;
    ControlOperations all;
    all.add({"status", "", "the state", {}, [](const json&) { return Result<json>(json{{"frames", 7}}); }});
    all.add({"echo",
             "",
             "the arguments",
             {{"whole", Kind::Whole, false, ""},
              {"text", Kind::Text, false, ""},
              {"truth", Kind::Truth, false, ""},
              {"scalar", Kind::Scalar, false, ""}},
             [](const json& arguments) { return Result<json>(arguments); }});
    all.add({"restart-node", "", "restart", {{"node", Kind::Whole, true, ""}}, [](const json& arguments) {
                 if (arguments.at("node") == 1) return Result<json>(json::object());
                 return Result<json>(Error{"the session has no node 2; its nodes are 0 to 1"});
             }});
    return all;
}

// Removes all unsent bytes and returns their lines.
inline std::vector<nlohmann::json> takeLines(ControlProtocol& protocol) {
    std::vector<nlohmann::json> lines;
    std::string text(protocol.unsent());
    protocol.sent(text.size());
    size_t at = 0;
    for (size_t end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        lines.push_back(parseJson(text.substr(at, end - at)));
    return lines;
}

} // namespace mural
