#include "nodes/head/planning/config/wall_parts.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "nodes/head/planning/compound_pass.hpp"

namespace mural {
namespace {

using compound::RenderContext;
using config::at;
using config::Index;

// Returns the bounding box of the draws.
Viewport boundsOf(const std::vector<ConfigDraw*>& draws) {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const ConfigDraw* d : draws) {
        const Viewport& a = d->onWall();
        x0 = std::min(x0, a.x);
        y0 = std::min(y0, a.y);
        x1 = std::max(x1, a.x + a.w);
        y1 = std::max(y1, a.y + a.h);
    }
    return {x0, y0, x1 - x0, y1 - y0};
}

// Returns the part of the wall that these draws of one destination and one eye compose.
WallPart makePart(const ConfigSource& source, const std::vector<ConfigDraw*>& draws, int firstPicture) {
    using config::ColorComponent;
    const RenderContext& first = draws.front()->context;
    WallPart part;
    part.name = source.channelName(first.destination);
    part.eye = first.eye;
    part.colours = {first.eyeColors.has(ColorComponent::Red), first.eyeColors.has(ColorComponent::Green),
                    first.eyeColors.has(ColorComponent::Blue)};
    part.area = boundsOf(draws);
    part.counts.kernelWidth = first.pixel.w;
    part.counts.kernelHeight = first.pixel.h;
    part.counts.samples = first.subPixel.size;
    part.firstPicture = firstPicture;
    return part;
}

// Sets the pictures of the part's draws.
Result<void> numberPictures(const ConfigSource& source, const WallPart& part, const std::vector<ConfigDraw*>& draws,
                            SessionPlan& plan) {
    const PassCounts& n = part.counts;
    std::set<int> made;
    for (ConfigDraw* d : draws) {
        const RenderContext& c = d->context;
        if (c.pixel.w != n.kernelWidth || c.pixel.h != n.kernelHeight || c.subPixel.size != n.samples)
            return Error{
                source.lineOf(source.config.compounds[at(c.compound)].at) + ": channel \"" + part.name +
                "\" combines parts with different pixel or subpixel kernels; give all of them the same kernel"};
        d->picture = part.firstPicture + pictureOf(n, passOf(source.config, c));
        made.insert(d->picture);
    }
    if (static_cast<int>(made.size()) < picturesOf(n))
        plan.warnings.push_back(source.file + ": channel \"" + part.name +
                                "\": no compound draws some pixels or samples of its kernel; they stay black");
    return {};
}

} // namespace

Result<void> placeParts(const ConfigSource& source, std::vector<ConfigDraw>& draws, SessionPlan& plan) {
    std::map<std::tuple<Index, Eye>, std::vector<ConfigDraw*>> parts;
    for (ConfigDraw& d : draws) parts[{d.context.destination, d.context.eye}].push_back(&d);
    int nextPicture = 0;
    bool anaglyph = false, quad = false;
    for (const auto& [key, partDraws] : parts) {
        WallPart part = makePart(source, partDraws, nextPicture);
        if (auto done = numberPictures(source, part, partDraws, plan); !done) return done.error();
        nextPicture += picturesOf(part.counts);
        const RenderContext& first = partDraws.front()->context;
        if (first.stereoMode == compound::StereoMode::Anaglyph) anaglyph = true;
        if (first.stereoMode == compound::StereoMode::Quad && first.eye == Eye::Left) quad = true;
        plan.wall.parts.push_back(std::move(part));
    }
    plan.wall.stereo = anaglyph ? StereoMode::Anaglyph : quad ? StereoMode::Quad : StereoMode::SideBySide;
    return {};
}

} // namespace mural
