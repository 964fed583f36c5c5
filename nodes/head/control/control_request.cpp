#include "nodes/head/control/control_request.hpp"

#include <algorithm>

#include "common/json/json_text.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr const char* kForm = R"(; send {"id":1,"op":"help"})";

std::string problemOf(const Json& request) {
    for (const auto& [name, value] : request.items())
        if (name != "id" && name != "op" && name != "args") return "a request has the members id, op and args only";
    if (const auto id = request.find("id"); id == request.end() || !id->is_number_integer())
        return "the member id of a request must be a whole number";
    if (const auto op = request.find("op"); op == request.end() || !op->is_string())
        return "the member op of a request must be the name of an operation";
    return "";
}

} // namespace

int depthOfJson(std::string_view line) {
    int depth = 0, deepest = 0;
    bool inString = false;
    for (size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (inString) {
            if (c == '\\') ++i;
            inString = c != '"';
            continue;
        }
        inString = c == '"';
        if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
        if (c == ']' || c == '}') --depth;
    }
    return deepest;
}

ControlRequest parseControlRequest(std::string_view line) {
    ControlRequest request;
    if (depthOfJson(line) > kMaxControlDepth) {
        request.problem = "a request may nest " + std::to_string(kMaxControlDepth) + " levels of values at most";
        return request;
    }
    Json json = parseJson(line);
    if (!json.is_object()) {
        request.problem = std::string("a request must be one object of JSON in one line of UTF-8") + kForm;
        return request;
    }
    if (const auto id = json.find("id"); id != json.end() && id->is_number_integer()) request.id = *id;
    request.problem = problemOf(json);
    if (!request.problem.empty()) {
        request.problem += kForm;
        return request;
    }
    request.operation = json["op"].get<std::string>();
    if (const auto args = json.find("args"); args != json.end()) request.arguments = std::move(*args);
    return request;
}

} // namespace mural
