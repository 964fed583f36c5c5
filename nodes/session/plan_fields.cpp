#include "nodes/session/plan_fields.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/json/json_text.hpp"

namespace mural {

namespace {

constexpr std::string_view kPlanFields[] = {
    "columns",    "rows",        "tileWidth", "tileHeight",    "chunks",    "balance",   "localNodes",  "hosts",
    "configFile", "allLocal",    "canvas",    "layouts",       "stereo",    "modelUnit", "kernelWidth", "kernelHeight",
    "samples",    "period",      "ranges",    "zoomX",         "zoomY",     "codec",     "readback",    "projection",
    "eyeBase",    "composition", "tiling",    "focusDistance", "movedHosts"};

} // namespace

nlohmann::json planFieldsOf(const SessionConfig& config) {
    const nlohmann::json all = parseJson(toJson(config));
    nlohmann::json fields = nlohmann::json::object();
    for (const std::string_view name : kPlanFields) fields[std::string(name)] = all.at(std::string(name));
    return fields;
}

Result<SessionConfig> withPlanFields(const SessionConfig& config, const nlohmann::json& fields) {
    nlohmann::json all = parseJson(toJson(config));
    for (const auto& [name, value] : fields.items()) {
        if (std::ranges::find(kPlanFields, name) == std::end(kPlanFields))
            return Error{"\"" + name.substr(0, 40) + "\" is no field of a plan; mural ctl plan lists them"};
        all[name] = value;
    }
    return sessionConfigFromJson(jsonText(all));
}

} // namespace mural
