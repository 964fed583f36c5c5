// JSON values from text and back. The parser and the writer of nlohmann/json take four seconds of compile time in every
// source that calls them, so one source does.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace mural {

// Returns a discarded value (is_discarded()) if the text is invalid.
[[nodiscard]] nlohmann::json parseJson(std::string_view text);

// Returns one line, or indented lines. Invalid UTF-8 in strings becomes U+FFFD.
[[nodiscard]] std::string jsonText(const nlohmann::json& value, int indent = -1);

} // namespace mural
