// The wall as the page draws it: canvases with their segments in millimetres and pixels. Origins are upper left
// corners.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/base/result.hpp"

namespace mural::page {

// options: the fields of the session's plan, as the operation `plan` returns them. width, height: size of the program's
// picture; 0: unknown. Reads the configuration file that the options name. Errors: the file is gone or wrong.
Result<nlohmann::json> wallDescription(const nlohmann::json& options, int width, int height);

// Returns the configuration file of the session, or the one that is equivalent to its options.
Result<std::string> configText(const nlohmann::json& options);
// Returns its drawing as SVG.
Result<std::string> configDrawing(const nlohmann::json& options);

} // namespace mural::page
