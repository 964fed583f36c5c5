#include "common/json/json_text.hpp"

#include <nlohmann/json.hpp>

namespace mural {

nlohmann::json parseJson(std::string_view text) { return nlohmann::json::parse(text, nullptr, false); }

std::string jsonText(const nlohmann::json& value, int indent) {
    return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace mural
