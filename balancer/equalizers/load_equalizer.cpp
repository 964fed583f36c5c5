#include "balancer/equalizers/load_equalizer.hpp"

namespace mural::balance {

namespace {

struct Extent {
    double from, to;
};

Extent extentAlong(const Part& part, Axis axis) {
    const Viewport& v = part.viewport;
    if (axis == Axis::X) return {v.x, v.x + v.w};
    if (axis == Axis::Y) return {v.y, v.y + v.h};
    return {part.range.start, part.range.end};
}

// Change of the time per length at a place.
struct Edge {
    double at, density;
};

// Returns the place at which the time of the tiles reaches `target`.
double placeOf(std::vector<Edge>& edges, double target, Extent within) {
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
    double density = 0, time = 0, place = within.from;
    for (const Edge& e : edges) {
        const double gained = density * (e.at - place);
        if (time + gained >= target && density > 0) return place + (target - time) / density;
        time += gained;
        place = e.at;
        density += e.density;
    }
    return within.to;
}

Part clip(const Part& part, const Part& within, Axis axis) {
    if (axis != Axis::Range) return {intersect(part.viewport, within.viewport), part.range};
    return {part.viewport,
            {std::max(part.range.start, within.range.start), std::min(part.range.end, within.range.end)}};
}

} // namespace

LoadEqualizer::LoadEqualizer(std::string id, const ResolvedConfig& config, Index compound,
                             const config::LoadEqualizer& fields)
    : SplitEqualizer(std::move(id), "load_equalizer", config, compound, fields.mode.value_or(SplitMode::TwoD)) {
    addCutParameters(fields.damping.value_or(.5), fields.boundary, fields.resistance);
    parameters_.addNumber("assemble_only_limit",
                          fields.assembleOnlyLimit.value_or(std::numeric_limits<double>::infinity()), 0,
                          std::numeric_limits<double>::infinity());
}

// The destination assembles the others' pictures, so it draws less.
void LoadEqualizer::setUsage(const States& states, std::vector<double>& usage) const {
    SplitEqualizer::setUsage(states, usage);
    double resources = 0, time = 0;
    for (const double u : usage) resources += u;
    for (const ChildLoad& load : children_.loads()) time += load.seconds;
    for (size_t i = 0; i < usage.size(); ++i) {
        if (children_.channel(i) != children_.destination() || usage[i] <= 0) continue;
        const double others = resources - usage[i];
        if (others <= 0) return;
        if (others >= parameters_.number("assemble_only_limit"))
            usage[i] = 0;
        else if (time > 0) // a resource's share of drawing and assembly together
            usage[i] =
                std::max(0., usage[i] - children_.assemblySeconds() * resources / (time + children_.assemblySeconds()));
        return;
    }
}

bool LoadEqualizer::split(const FrameContext&, const CutRules& rules) {
    std::vector<Tile> tiles;
    double longest = 0, sum = 0;
    size_t active = 0;
    for (const ChildLoad& load : children_.loads()) {
        if (!load.hasDrawn) continue;
        const bool hasInterest = mode() != SplitMode::Db && !load.interest.empty();
        tiles.push_back({{hasInterest ? load.interest : load.area, load.range}, load.seconds});
        longest = std::max(longest, load.seconds);
        sum += load.seconds;
        ++active;
    }
    divide(0, {}, tiles, rules, parameters_.number("damping"));
    const double balance = sum / (static_cast<double>(active) * longest);
    decision_.what = "cuts moved towards equal times";
    decision_.predictedGain = (1 - balance) * (1 - parameters_.number("damping"));
    decision_.inputs = {{"longest", longest}, {"sum", sum}, {"efficiency", balance}};
    return true;
}

void LoadEqualizer::divide(int index, const Part& part, const std::vector<Tile>& tiles, const CutRules& rules,
                           double damping) {
    SplitNode& node = tree_.nodes()[static_cast<size_t>(index)];
    if (node.isLeaf()) return;
    const Extent whole = extentAlong(part, node.axis);
    const double low = rules.usageOf(tree_.low(node)), high = rules.usageOf(tree_.high(node));
    std::vector<Edge> edges;
    double time = 0;
    for (const Tile& t : tiles) {
        const Extent e = extentAlong(t.part, node.axis);
        if (!(e.to > e.from)) continue;
        edges.push_back({e.from, t.seconds / (e.to - e.from)});
        edges.push_back({e.to, -t.seconds / (e.to - e.from)});
        time += t.seconds;
    }
    double wanted = node.at;
    if (time > 0 && low + high > 0 && whole.to > whole.from) {
        const double place = placeOf(edges, time * low / (low + high), whole);
        const double target = (place - whole.from) / (whole.to - whole.from);
        wanted = (1 - damping) * target + damping * node.at;
    }
    if (damping < 1 || low == 0 || high == 0) tree_.moveCut(node, part, wanted, rules);
    const auto halves = cutPart(part, node.axis, node.at);
    for (const bool isLow : {true, false}) {
        const Part& half = isLow ? halves.first : halves.second;
        std::vector<Tile> inside;
        for (const Tile& t : tiles) {
            const Part clipped = clip(t.part, half, node.axis);
            const Extent before = extentAlong(t.part, node.axis), after = extentAlong(clipped, node.axis);
            if (!(after.to > after.from) || !(before.to > before.from)) continue;
            inside.push_back({clipped, t.seconds * (after.to - after.from) / (before.to - before.from)});
        }
        divide(isLow ? node.low : node.high, half, inside, rules, damping);
    }
}

} // namespace mural::balance
