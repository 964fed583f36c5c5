// What a recording says of itself, as JSON behind the file's header: for people, nothing depends on it.
#pragma once

#include <string>
#include <vector>

#include "common/result.hpp"

namespace mural::recording {

struct About {
    std::string version;            // of Mural
    std::vector<std::string> nodes; // GL of the nodes it was recorded with
    std::string trimmed;            // what was left out by `mural trim`; empty: nothing
};

std::string toJson(const About& about);
Result<About> aboutFromJson(const std::string& text);

} // namespace mural::recording
