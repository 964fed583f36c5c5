#include "nodes/render/node_description.hpp"

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <unistd.h>
#include <vector>

#include "nodes/gl/gl_probe.hpp"

namespace mural {

namespace {

std::string hostName() {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

} // namespace

nlohmann::json describeNode(gl::Platform& platform) {
    nlohmann::json node;
    node["host"] = hostName();
    node["pid"] = getpid();
    std::set<std::string> extensions;
    int best = 0, maxPixels = 0;
    const auto add = [&](gl::Api api, bool core) {
        const auto p = gl::probe(platform, api, core);
        if (!p) return;
        extensions.insert(p.value().extensions.begin(), p.value().extensions.end());
        if (api == gl::Api::Desktop && p.value().glVersion > best) best = p.value().glVersion;
        if (maxPixels == 0 || p.value().maxSurfaceSize < maxPixels) maxPixels = p.value().maxSurfaceSize;
        const std::string &renderer = p.value().renderer, &backend = p.value().backend;
        if (!node.contains("renderer"))
            node["renderer"] = backend.find(renderer) != std::string::npos ? backend : renderer + ", " + backend;
    };
    add(gl::Api::Desktop, false);
    add(gl::Api::Desktop, true);
    add(gl::Api::Es2, false);
    add(gl::Api::Es1, false);
    const std::vector<std::string> images = platform.imageExtensions();
    extensions.insert(images.begin(), images.end());
    if (images.empty())
        std::erase_if(extensions, [](const std::string& name) { return name.find("_EGL_image") != std::string::npos; });
    node["glVersion"] = best;
    node["maxPixels"] = maxPixels;
    node["extensions"] = std::vector<std::string>(extensions.begin(), extensions.end());
    return node;
}

} // namespace mural
