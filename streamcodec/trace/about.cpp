#include "streamcodec/trace/about.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"

namespace mural::trace {
namespace {

using Json = nlohmann::json;

std::string textOf(const Json& json, const char* name) {
    const auto found = json.find(name);
    return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

} // namespace

std::string toJson(const About& about) {
    Json json{{"version", about.version}, {"nodes", about.nodes}};
    if (!about.trimmed.empty()) json["trimmed"] = about.trimmed;
    return jsonText(json);
}

Result<About> aboutFromJson(const std::string& text) {
    const Json json = parseJson(text);
    if (!json.is_object()) return Error{"its description is not JSON"};
    About about;
    about.version = textOf(json, "version");
    about.trimmed = textOf(json, "trimmed");
    if (const auto nodes = json.find("nodes"); nodes != json.end() && nodes->is_array())
        for (const Json& node : *nodes)
            if (node.is_string()) about.nodes.push_back(node.get<std::string>());
    return about;
}

} // namespace mural::trace
