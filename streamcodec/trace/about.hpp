// Metadata of a trace, as JSON after the file's header. Informational only.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::trace {

struct About {
    std::string version;            // Mural's version
    std::vector<std::string> nodes; // GL of the recording nodes
    std::string trimmed;            // parts removed by `mural trim`; empty: none
};

std::string toJson(const About& about);
Result<About> aboutFromJson(const std::string& text);

} // namespace mural::trace
