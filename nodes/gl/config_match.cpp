#include "nodes/gl/config_match.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace mural::gl {
namespace {

struct Attribute {
    const char* name;
    int (*value)(const SurfaceConfig&);
};

// A count of one sample means no multisampling, as with none: drivers report either.
const std::array<Attribute, 10> kAttributes{{
    {"red", [](const SurfaceConfig& c) { return c.red; }},
    {"green", [](const SurfaceConfig& c) { return c.green; }},
    {"blue", [](const SurfaceConfig& c) { return c.blue; }},
    {"alpha", [](const SurfaceConfig& c) { return c.alpha; }},
    {"depth", [](const SurfaceConfig& c) { return c.depth; }},
    {"stencil", [](const SurfaceConfig& c) { return c.stencil; }},
    {"samples", [](const SurfaceConfig& c) { return c.samples <= 1 ? 0 : c.samples; }},
    {"accum", [](const SurfaceConfig& c) { return c.accum; }},
    {"srgb", [](const SurfaceConfig& c) { return c.srgb ? 1 : 0; }},
    {"stereo", [](const SurfaceConfig& c) { return c.stereo ? 1 : 0; }},
}};

std::string join(const std::set<int>& values) {
    std::string text;
    for (int value : values) text += (text.empty() ? "" : ", ") + std::to_string(value);
    return text;
}

Error noMatch(const std::string& backend, size_t failed, const SurfaceConfig& wish, const std::set<int>& offered) {
    std::string met;
    for (size_t i = 0; i < failed; i++)
        met += std::string(met.empty() ? " with " : ", ") + kAttributes[i].name + " " +
               std::to_string(kAttributes[i].value(wish));
    return Error{backend + " has no framebuffer" + met + " that has " + kAttributes[failed].name + " " +
                 std::to_string(kAttributes[failed].value(wish)) + " (it has " + join(offered) +
                 "): try another backend with --gl"};
}

} // namespace

Result<size_t> matchConfig(const std::string& backend,
                           const std::vector<ConfigCandidate>& candidates,
                           const SurfaceConfig& wish) {
    if (candidates.empty()) return Error{backend + " offers no framebuffer to draw into: see mural doctor"};
    std::vector<size_t> left(candidates.size());
    for (size_t i = 0; i < left.size(); i++) left[i] = i;
    for (size_t a = 0; a < kAttributes.size(); a++) {
        std::set<int> offered;
        std::vector<size_t> equal;
        for (size_t i : left) {
            const int value = kAttributes[a].value(candidates[i].bits);
            offered.insert(value);
            if (value == kAttributes[a].value(wish)) equal.push_back(i);
        }
        if (equal.empty()) return noMatch(backend, a, wish, offered);
        left = std::move(equal);
    }
    return *std::min_element(left.begin(), left.end(), [&](size_t one, size_t other) {
        return candidates[one].rank != candidates[other].rank ? candidates[one].rank < candidates[other].rank
                                                              : one < other;
    });
}

bool sameBits(const SurfaceConfig& one, const SurfaceConfig& other) {
    return std::all_of(kAttributes.begin(), kAttributes.end(),
                       [&](const Attribute& a) { return a.value(one) == a.value(other); });
}

Result<void> checkSize(const std::string& backend, const SurfaceConfig& wish, int maxSize) {
    if (wish.width >= 1 && wish.height >= 1 && wish.width <= maxSize && wish.height <= maxSize) return {};
    return Error{backend + " can't make a surface of " + std::to_string(wish.width) + "x" +
                 std::to_string(wish.height) + " pixels (1x1 to " + std::to_string(maxSize) + "x" +
                 std::to_string(maxSize) + "): draw a smaller picture"};
}

VersionRequest versionRequest(const ContextConfig& config) {
    if (config.api != Api::Desktop) return {config.major, config.minor, false};
    const int version = 10 * config.major + config.minor;
    if (version == 31) return {3, 2, true};
    return {config.major, config.minor, version > 31};
}

std::string describeContext(const ContextConfig& config) {
    std::string text = config.api == Api::Desktop ? "OpenGL " : "OpenGL ES ";
    text += std::to_string(config.major) + "." + std::to_string(config.minor);
    if (config.api == Api::Desktop) text += config.core ? " core" : " compatibility";
    if (config.forwardCompatible) text += ", forward-compatible";
    if (config.debug) text += ", debug";
    if (config.robust) text += ", robust";
    return text;
}

} // namespace mural::gl
