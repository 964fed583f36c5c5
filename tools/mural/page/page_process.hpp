// The process of a page: its hub, its listener, and its limits.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/base/result.hpp"
#include "tools/mural/page/page_options.hpp"

namespace mural::page {

// Serves the page until the session ends, `mural page --off`, or a signal. hello: of the head. Errors: the page cannot
// start.
Result<void> servePage(const PageArguments& arguments, const PageAddress& address, bool hasTls,
                       const std::string& controlPath, const nlohmann::json& hello);

} // namespace mural::page
