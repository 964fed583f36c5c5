#include "tools/mural/page/hub/page_replies.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "nodes/head/control/control_operations.hpp"
#include "tools/mural/page/hub/page_hub.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

Json argumentOf(const char* name, const char* type, bool isRequired, const char* meaning) {
    return {{"name", name}, {"type", type}, {"required", isRequired}, {"meaning", meaning}};
}

Json operationOf(const char* name, const char* meaning, Json arguments = Json::array()) {
    return {{"name", name}, {"usage", name}, {"meaning", meaning}, {"arguments", std::move(arguments)}};
}

} // namespace

Json failureOf(const std::string& code, const std::string& error) {
    return {{"ok", false}, {"code", code}, {"error", error}};
}

Json replyOf(const Result<Json>& result) {
    if (!result) return failureOf(control_code::kBadArgument, result.error().message);
    return {{"ok", true}, {"result", result.value()}};
}

Json limitsJson() {
    return {{"textBytes", kMaxTextMessageBytes},
            {"requestsPerSecond", 20},
            {"inputsPerSecond", 500},
            {"clients", kMaxViewers},
            {"inFlight", ViewerFlow::kMaxInFlight}};
}

std::string logLineOf(const Json& entry) {
    if (const auto event = entry.find("event"); event != entry.end() && event->is_string()) {
        if (*event == "frame" || *event == "clients") return {};
        std::string line = event->get<std::string>();
        if (const auto node = entry.find("node"); node != entry.end() && node->is_number_integer())
            line += ": node " + std::to_string(node->get<int64_t>());
        if (const auto text = entry.find("text"); text != entry.end() && text->is_string())
            line += ": " + text->get<std::string>();
        return line;
    }
    const auto text = entry.find("text");
    if (text == entry.end() || !text->is_string()) return {};
    const auto level = entry.find("level");
    return (level != entry.end() && level->is_string() ? level->get<std::string>() + ": " : "") +
           text->get<std::string>();
}

bool namesNode(const std::string& line, int node) {
    const std::string name = "node " + std::to_string(node);
    for (size_t at = line.find(name); at != std::string::npos; at = line.find(name, at + 1)) {
        const size_t end = at + name.size();
        if (end >= line.size() || line[end] < '0' || line[end] > '9') return true;
    }
    return false;
}

void addOwnOperations(Json& operations) {
    if (!operations.is_array()) return;
    operations.push_back(
        operationOf("preview", "send pictures of the wall, or of the part of a node",
                    {argumentOf("class", "text", true, "thumb, preview, full or off"),
                     argumentOf("of", "scalar", false, "wall, or the number of a node; missing: wall")}));
    operations.push_back(operationOf("wall", "canvases, their segments, and the size of the program's picture"));
    operations.push_back(operationOf("input-take", "take the lease of the input"));
    operations.push_back(operationOf("input-release", "give the lease of the input back"));
    operations.push_back(operationOf("links", "the links to this page"));
    operations.push_back(operationOf("link-new", "create a link",
                                     {argumentOf("role", "text", false, "view, input or operate; missing: view"),
                                      argumentOf("seconds", "whole", false, "lifetime; 0: as long as the session"),
                                      argumentOf("most", "whole", false, "pages open at once; 0: no limit"),
                                      argumentOf("name", "text", false, "for the list of links")}));
    operations.push_back(operationOf("link-revoke", "end a link and close its pages",
                                     {argumentOf("link", "whole", true, "number of the link")}));
}

} // namespace mural::page
