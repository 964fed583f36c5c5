#include "nodes/gl/config_match.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace mural::gl {
namespace {

// Values that may replace the requested value of an attribute.
enum class Other { None, Any, AnyButZero };

struct Attribute {
    const char* name;
    int (*value)(const SurfaceConfig&);
    Other other = Other::None;
};

// A count of one sample means no multisampling, as with none: drivers report either.
const std::array<Attribute, 10> kAttributes{{
    {"red", [](const SurfaceConfig& c) { return c.red; }, Other::Any},
    {"green", [](const SurfaceConfig& c) { return c.green; }, Other::Any},
    {"blue", [](const SurfaceConfig& c) { return c.blue; }, Other::Any},
    {"alpha", [](const SurfaceConfig& c) { return c.alpha; }, Other::AnyButZero},
    {"depth", [](const SurfaceConfig& c) { return c.depth; }, Other::Any},
    {"stencil", [](const SurfaceConfig& c) { return c.stencil; }, Other::Any},
    {"samples", [](const SurfaceConfig& c) { return c.samples <= 1 ? 0 : c.samples; }, Other::Any},
    {"accum", [](const SurfaceConfig& c) { return c.accum; }},
    {"srgb", [](const SurfaceConfig& c) { return c.srgb ? 1 : 0; }},
    {"stereo", [](const SurfaceConfig& c) { return c.stereo ? 1 : 0; }},
}};

// Returns whether a surface with `offered` can replace one with `requested`. An absent alpha channel reads as 1 in
// blending, so zero and non-zero alpha never replace each other.
bool isAcceptable(const Attribute& attribute, int requested, int offered) {
    if (offered == requested || attribute.other == Other::Any) return true;
    return attribute.other == Other::AnyButZero && requested != 0 && offered != 0;
}

// Substitutes the smallest offered value above the requested one, or the largest offered one if none is above. Returns
// the requested value itself if it is offered.
int nearestTo(int requested, const std::set<int>& offered) {
    const auto above = offered.lower_bound(requested);
    return above != offered.end() ? *above : *offered.rbegin();
}

std::string join(const std::set<int>& values) {
    std::string text;
    for (int value : values) text += (text.empty() ? "" : ", ") + std::to_string(value);
    return text;
}

Error noMatch(const std::string& backend, size_t failed, const SurfaceConfig& requested, const std::set<int>& offered) {
    std::string met;
    for (size_t i = 0; i < failed; i++)
        met += std::string(met.empty() ? " with " : ", ") + kAttributes[i].name + " " +
               std::to_string(kAttributes[i].value(requested));
    return Error{backend + " has no framebuffer" + met + " that has " + kAttributes[failed].name + " " +
                 std::to_string(kAttributes[failed].value(requested)) + " (it has " + join(offered) +
                 "): try another backend with --gl"};
}

} // namespace

Result<size_t> matchConfig(const std::string& backend, const std::vector<ConfigCandidate>& candidates,
                           const SurfaceConfig& requested) {
    if (candidates.empty()) return Error{backend + " offers no framebuffer to draw into: see mural doctor"};
    std::vector<size_t> left(candidates.size());
    for (size_t i = 0; i < left.size(); i++) left[i] = i;
    for (size_t a = 0; a < kAttributes.size(); a++) {
        std::set<int> offered;
        for (size_t i : left) offered.insert(kAttributes[a].value(candidates[i].bits));
        const int wanted = kAttributes[a].value(requested);
        std::set<int> acceptable;
        for (const int value : offered)
            if (isAcceptable(kAttributes[a], wanted, value)) acceptable.insert(value);
        if (acceptable.empty()) return noMatch(backend, a, requested, offered);
        const int taken = nearestTo(wanted, acceptable);
        std::erase_if(left, [&](size_t i) { return kAttributes[a].value(candidates[i].bits) != taken; });
    }
    return *std::min_element(left.begin(), left.end(), [&](size_t one, size_t other) {
        return candidates[one].rank != candidates[other].rank ? candidates[one].rank < candidates[other].rank
                                                              : one < other;
    });
}

SurfaceConfig bitsOf(const ConfigCandidate& taken, const SurfaceConfig& requested) {
    SurfaceConfig bits = taken.bits;
    bits.width = requested.width;
    bits.height = requested.height;
    return bits;
}

std::string describeDifference(const SurfaceConfig& there, const SurfaceConfig& requested) {
    std::string text;
    for (const Attribute& a : kAttributes) {
        if (a.value(there) == a.value(requested)) continue;
        text += (text.empty() ? "" : ", ") + std::string(a.name) + " " + std::to_string(a.value(there)) +
                " instead of " + std::to_string(a.value(requested));
    }
    return text;
}

bool sameBits(const SurfaceConfig& one, const SurfaceConfig& other) { return describeDifference(one, other).empty(); }

Result<void> checkSize(const std::string& backend, const SurfaceConfig& requested, int maxSize) {
    if (requested.width >= 1 && requested.height >= 1 && requested.width <= maxSize && requested.height <= maxSize)
        return {};
    return Error{backend + " cannot make a surface of " + std::to_string(requested.width) + "x" +
                 std::to_string(requested.height) + " pixels (1x1 to " + std::to_string(maxSize) + "x" +
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
