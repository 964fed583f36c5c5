#include "tools/mural/app_report/runs/hidden_extensions.hpp"

#include <algorithm>
#include <sstream>

#include "nodes/gl/gl_probe.hpp"
#include "streamcodec/command_table.hpp"
#include "tools/mural/doctor/doctor_checks.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kGlMs = 5'000;

} // namespace

std::vector<std::string> hiddenExtensions() {
    const Isolated found = inChild(
        []() -> Isolated {
            auto platform = gl::openPlatform("auto");
            if (!platform) return {false, platform.error().message};
            const auto probe = gl::probe(**platform, gl::Api::Desktop, false);
            if (!probe) return {false, probe.error().message};
            Isolated hidden{true, {}};
            for (const std::string& name : probe.value().extensions)
                if (!extensionCarried(name)) hidden.text += name + " ";
            return hidden;
        },
        kGlMs);
    std::vector<std::string> names;
    if (!found.ok) return names;
    std::istringstream words(found.text);
    for (std::string name; words >> name;) names.push_back(name);
    std::ranges::sort(names);
    return names;
}

} // namespace mural::cli
