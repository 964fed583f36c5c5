#include "nodes/head/membership/node_capabilities.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "common/json/json_text.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

std::string textOf(const Json& json, const char* name) {
    const auto found = json.find(name);
    return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

// Accepts "4.5 (Core Profile) Mesa 22.3.6", "OpenGL ES 3.2 Mesa" and 45.
int versionOf(const Json& json) {
    const auto found = json.find("glVersion");
    if (found == json.end()) return 0;
    if (found->is_number_integer()) return found->get<int>();
    if (!found->is_string()) return 0;
    const auto text = found->get<std::string>();
    const auto isDigit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const auto at = std::ranges::find_if(text, isDigit);
    int major = 0;
    int minor = 0;
    const int got = std::sscanf(text.c_str() + (at - text.begin()), "%2d.%1d", &major, &minor);
    return got == 2 ? 10 * major + minor : 0;
}

std::vector<std::string> extensionsOf(const Json& json) {
    std::vector<std::string> all;
    const auto found = json.find("extensions");
    if (found == json.end()) return all;
    if (found->is_string()) {
        std::istringstream words(found->get<std::string>());
        for (std::string word; words >> word;) all.push_back(word);
    }
    if (found->is_array()) {
        for (const Json& entry : *found)
            if (entry.is_string()) all.push_back(entry.get<std::string>());
    }
    return all;
}

} // namespace

Result<NodeCapabilities> nodeFactsFromJson(const std::string& text) {
    const Json json = parseJson(text);
    if (!json.is_object())
        return Error{"its ready message is not JSON; install the same version of mural on all machines"};
    NodeCapabilities facts;
    facts.host = textOf(json, "host");
    facts.renderer = textOf(json, "renderer");
    facts.placement = textOf(json, "placement");
    facts.exchange = textOf(json, "exchange");
    facts.swapBarrier = textOf(json, "swapBarrier");
    facts.ownStream = textOf(json, "ownStream");
    facts.glVersion = versionOf(json);
    if (const auto maximum = json.find("maxPixels"); maximum != json.end() && maximum->is_number_integer())
        facts.maxPixels = maximum->get<int64_t>();
    facts.extensions = extensionsOf(json);
    const auto pid = json.find("pid");
    if (pid != json.end() && pid->is_number_integer()) facts.pid = pid->get<int64_t>();
    return facts;
}

int lowestGlVersion(const std::vector<NodeCapabilities>& nodes) {
    int lowest = 0;
    for (const NodeCapabilities& facts : nodes)
        if (facts.glVersion > 0 && (lowest == 0 || facts.glVersion < lowest)) lowest = facts.glVersion;
    return lowest;
}

std::string commonExtensions(const std::vector<NodeCapabilities>& nodes) {
    if (nodes.empty()) return "";
    std::set<std::string> common(nodes[0].extensions.begin(), nodes[0].extensions.end());
    for (const NodeCapabilities& facts : nodes) {
        const std::set<std::string> here(facts.extensions.begin(), facts.extensions.end());
        std::erase_if(common, [&](const std::string& name) { return !here.contains(name); });
    }
    std::string text;
    for (const std::string& name : common) text += (text.empty() ? "" : " ") + name;
    return text;
}

} // namespace mural
