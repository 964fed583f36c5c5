#include "balancer/equalizers/cost_map/cost_map_equalizer.hpp"

#include <cmath>

namespace mural::balance {

namespace {

constexpr size_t kCellsPerChild = 64; // enough to place a cut within a few percent of a child's part
constexpr size_t kLeastCells = 2048, kMostCells = 8192;
constexpr double kLeastDensity = 1e-3;   // of the mean: a cell that was free can become dear
constexpr double kAspectToTurn = 2;      // a cut turns to the other axis above this ratio of sides
constexpr double kSurpriseToSmooth = .6; // residual from which the map is smoothed completely
constexpr int kSmoothings = 2;
constexpr size_t kMemory = 3; // frames with different parts that the map agrees with
constexpr int kRecalls = 2;
constexpr int kFirstPatience = 8, kMostPatience = 64;
constexpr int kQuietFrames = 4;     // frames of the same parts without a promised gain before a rest
constexpr double kGainToWake = .10; // a promised gain that ends a rest
constexpr int kFramesToWake = 4;    // frames of the same parts that show it
constexpr double kSlowest = .1;     // speed relative to the mean
constexpr double kOtherUsage = .25;
constexpr double kUnknownNoise = .12; // assumed before the noise is known
constexpr int kCalmFrames = 12;       // a longer rest means that the load changes rarely

Axis axisOf(SplitMode mode) { return mode == SplitMode::Db ? Axis::Range : Axis::X; }

bool isSame(const std::vector<Part>& a, const std::vector<Part>& b) {
    constexpr double kNear = 1e-6;
    const auto near = [](double x, double y) { return std::abs(x - y) < kNear; };
    if (a.size() != b.size()) return false;
    for (size_t i = 0; i < a.size(); ++i) {
        const Viewport &v = a[i].viewport, &w = b[i].viewport;
        if (!near(v.x, w.x) || !near(v.y, w.y) || !near(v.w, w.w) || !near(v.h, w.h)) return false;
        if (!near(a[i].range.start, b[i].range.start) || !near(a[i].range.end, b[i].range.end)) return false;
    }
    return true;
}

} // namespace

CostMapEqualizer::CostMapEqualizer(std::string id, const ResolvedConfig& config, Index compound, SplitMode mode)
    : SplitEqualizer(std::move(id), "cost_map", config, compound, mode),
      speeds_(children_.size(), 1),
      residuals_(children_.size(), 0),
      patience_(kFirstPatience) {
    addCutParameters(0, {}, {});
    parameters_.addNumber("smoothing", .3, 0, 1);
    parameters_.addNumber("gain", .02, 0, 1);
    parameters_.addNumber("speed_learning", .1, 0, 1);
}

void CostMapEqualizer::makeMap() {
    const size_t cells = std::clamp(kCellsPerChild * children_.size(), kLeastCells, kMostCells);
    if (mode() == SplitMode::Db) {
        map_ = DensityGrid(cells / 4, 1);
        return;
    }
    const double aspect = area_.empty() ? 16. / 9 : double(area_.w) / area_.h;
    const auto columns = std::clamp(std::sqrt(static_cast<double>(cells) * aspect), 8., static_cast<double>(cells) / 8);
    map_ = DensityGrid(static_cast<size_t>(columns), std::max<size_t>(8, static_cast<size_t>(double(cells) / columns)));
}

// The destination assembles the others' pictures, so it draws less. Released helpers draw nothing.
void CostMapEqualizer::setUsage(const States& states, std::vector<double>& usage) const {
    SplitEqualizer::setUsage(states, usage);
    size_t helpers = 0;
    for (size_t i = 0; i < usage.size(); ++i) helpers += children_.channel(i) != children_.destination();
    size_t released = helpers - helpers_.working(helpers);
    double resources = 0, work = 0;
    for (size_t i = usage.size(); i-- > 0;) {
        if (released > 0 && children_.channel(i) != children_.destination()) {
            usage[i] = 0;
            --released;
        }
        usage[i] *= speeds_[i];
        resources += usage[i];
    }
    for (const double s : seconds_) work += s;
    const double assembly = children_.assemblySeconds();
    for (size_t i = 0; i < usage.size(); ++i) {
        if (children_.channel(i) != children_.destination() || work <= 0 || resources <= usage[i]) continue;
        usage[i] = std::max(0., usage[i] - assembly * resources / (work + assembly));
    }
}

void CostMapEqualizer::learn(const FrameStatistics&) {
    if (map_.columns() == 0) makeMap();
    watch();
    correctMap();
    learnSpeeds();
    size_t helpers = 0, all = 0;
    double work = 0;
    bool drawsItself = false;
    for (size_t i = 0; i < children_.size(); ++i) {
        const bool isHelper = children_.channel(i) != children_.destination();
        all += isHelper;
        drawsItself |= !isHelper;
        helpers += isHelper && children_.loads()[i].hasDrawn;
        work += children_.loads()[i].seconds;
    }
    helpers_.observe(work, children_.assemblySeconds(), helpers);
    helpers_.choose(all, drawsItself, std::max(.05, 2 * watch_.noise()));
}

void CostMapEqualizer::watch() {
    std::vector<Part> parts;
    seconds_.clear();
    for (const ChildLoad& load : children_.loads()) {
        const Part none{{0, 0, 0, 0}, {0, 0}};
        parts.push_back(load.hasDrawn ? Part{load.area, load.range} : none);
        if (load.hasDrawn) seconds_.push_back(load.seconds);
    }
    if (!isSame(parts, drawn_)) watch_.restart();
    drawn_ = std::move(parts);
    if (watch_.add(seconds_)) {
        isChanged_ = true;
        watch_.restart();
        (void)watch_.add(seconds_);
    }
    if (isResting_) ++restedFrames_;
}

// Multiplies the density within each part by measured / predicted time. Residuals within the noise are averaged over
// the frames of the same parts; larger ones count at once, and then the map is made to agree with earlier frames again.
void CostMapEqualizer::correctMap() {
    findResiduals();
    bool isSurprise = false;
    for (int round = 0; round < kSmoothings && !isResting_; ++round) {
        if (!smoothMap(round == 0)) break;
        isSurprise = true;
        findResiduals();
    }
    if (isSurprise) recall();
    const int frames = isResting_ ? 64 : isVarying_ ? 1 : 4; // an old average lags behind a load that varies
    const double average = 1. / (std::min(watch_.frames(), frames) + 1.);
    for (size_t i = 0; i < drawn_.size(); ++i) {
        if (drawn_[i].empty()) continue;
        const double sure = std::clamp((std::abs(residuals_[i]) / watch_.noise() - sureDeviations()) / 2, 0., 1.);
        const double gain = average + (1 - average) * sure;
        map_.scale(cellsOf(drawn_[i]), std::exp(std::clamp(gain * residuals_[i], -8., 8.)));
    }
    map_.sum();
    remember();
}

// Deviations that the noise of one frame hardly reaches.
double CostMapEqualizer::sureDeviations() const { return isVarying_ ? 1 : 1.5 + noiseDeviations(); }

// Keeps the frames of the last few different parts. A load that varies makes them worthless.
void CostMapEqualizer::remember() {
    if (isVarying_) {
        memory_.clear();
        return;
    }
    if (!memory_.empty() && isSame(memory_.back().parts, drawn_)) memory_.pop_back();
    if (memory_.size() >= kMemory) memory_.erase(memory_.begin());
    Memory m;
    m.parts = drawn_;
    for (size_t i = 0; i < drawn_.size(); ++i)
        m.costs.push_back(drawn_[i].empty() ? 0 : map_.of(drawn_[i], axisOf(mode())) / map_.total());
    memory_.push_back(std::move(m));
}

void CostMapEqualizer::recall() {
    for (int round = 0; round < kRecalls && !memory_.empty(); ++round) {
        for (const Memory& m : memory_) {
            const double total = map_.total();
            costs_.clear();
            for (const Part& part : m.parts) costs_.push_back(part.empty() ? 0 : map_.of(part, axisOf(mode())) / total);
            for (size_t i = 0; i < m.parts.size(); ++i)
                if (!m.parts[i].empty() && costs_[i] > 0)
                    map_.scale(cellsOf(m.parts[i]), std::clamp(m.costs[i] / costs_[i], 1e-3, 1e3));
            map_.sum();
        }
        findResiduals();
        for (size_t i = 0; i < drawn_.size(); ++i)
            if (!drawn_[i].empty()) map_.scale(cellsOf(drawn_[i]), std::exp(std::clamp(residuals_[i], -8., 8.)));
        map_.sum();
    }
    findResiduals();
}

// Where the times surprise, the shape of the map is wrong, too: the neighbourhood tells more than the old shape.
// Returns false if nothing surprises.
bool CostMapEqualizer::smoothMap(bool isFirst) {
    bool any = false;
    if (isFirst) surprises_ = residuals_;
    for (size_t i = 0; i < drawn_.size(); ++i) {
        const double surprise = (std::abs(surprises_[i]) - sureDeviations() * watch_.noise()) / kSurpriseToSmooth;
        if (drawn_[i].empty() || surprise <= 0) continue;
        any = true;
        if (!isFirst) map_.scale(cellsOf(drawn_[i]), std::exp(std::clamp(residuals_[i], -8., 8.)));
    }
    if (any && !isFirst) map_.sum();
    for (size_t i = 0; i < drawn_.size() && any; ++i) {
        const double surprise = (std::abs(surprises_[i]) - sureDeviations() * watch_.noise()) / kSurpriseToSmooth;
        if (drawn_[i].empty() || surprise <= 0) continue;
        map_.smooth(cellsOf(drawn_[i]), parameters_.number("smoothing") * std::min(1., surprise));
    }
    if (!any) return false;
    map_.raise(kLeastDensity);
    map_.sum();
    return true;
}

Viewport CostMapEqualizer::cellsOf(const Part& part) const {
    if (mode() != SplitMode::Db) return part.viewport;
    return {part.range.start, 0, part.range.end - part.range.start, 1};
}

// Scales the map to the sum of the times. Sets the residuals and returns their root mean square.
double CostMapEqualizer::findResiduals() {
    const Axis axis = axisOf(mode());
    std::fill(residuals_.begin(), residuals_.end(), 0);
    double measured = 0, predicted = 0;
    for (size_t i = 0; i < drawn_.size(); ++i) {
        if (drawn_[i].empty()) continue;
        residuals_[i] = std::max(map_.of(drawn_[i], axis) / speeds_[i], 1e-12);
        measured += children_.loads()[i].seconds;
        predicted += residuals_[i];
    }
    const double factor = measured / predicted;
    map_.scaleAll(factor);
    double squares = 0;
    for (size_t i = 0; i < drawn_.size(); ++i) {
        if (drawn_[i].empty()) continue;
        residuals_[i] = std::log(children_.loads()[i].seconds / (residuals_[i] * factor));
        squares += residuals_[i] * residuals_[i];
    }
    return std::sqrt(squares / static_cast<double>(seconds_.size()));
}

// A child whose parts take longer than the map expects, wherever they are, is slow. While cuts move, a small share of
// each residual counts for the speed; the common factor of all speeds is 1.
void CostMapEqualizer::learnSpeeds() {
    const double rate = parameters_.number("speed_learning");
    if (isResting_ || rate <= 0) return;
    double sum = 0;
    for (size_t i = 0; i < speeds_.size(); ++i) {
        const double change = drawn_[i].empty() ? 0 : std::clamp(residuals_[i], -1., 1.);
        speeds_[i] = std::clamp(speeds_[i] * std::exp(-rate * change), kSlowest, 1 / kSlowest);
        sum += speeds_[i];
    }
    for (double& speed : speeds_) speed *= static_cast<double>(speeds_.size()) / sum;
}

void CostMapEqualizer::cut(SplitTree& tree, int index, const Part& part, const CutRules& rules) const {
    SplitNode& node = tree.nodes()[static_cast<size_t>(index)];
    if (node.isLeaf()) return;
    if (mode() == SplitMode::TwoD) {
        const double aspect = area_.empty() ? 16. / 9 : double(area_.w) / area_.h;
        const double ratio = part.viewport.w * aspect / std::max(part.viewport.h, 1e-9);
        if (ratio > kAspectToTurn) node.axis = Axis::X;
        if (ratio < 1 / kAspectToTurn) node.axis = Axis::Y;
    }
    const double low = rules.usageOf(tree.low(node)), all = rules.usageOf(node);
    const double wanted = all > 0 ? map_.cutOf(part, node.axis, low / all) : node.at;
    tree.moveCut(node, part, wanted, rules);
    const auto halves = cutPart(part, node.axis, node.at);
    cut(tree, node.low, halves.first, rules);
    cut(tree, node.high, halves.second, rules);
}

double CostMapEqualizer::longestOf(const std::vector<Part>& parts) const {
    double longest = 0;
    for (size_t i = 0; i < parts.size(); ++i)
        if (!parts[i].empty()) longest = std::max(longest, map_.of(parts[i], axisOf(mode())) / speeds_[i]);
    return longest;
}

double CostMapEqualizer::noiseGain() const {
    const double noise = watch_.noise() / std::sqrt(std::min(watch_.frames(), 4) + 1.5);
    return noise * noiseDeviations();
}

double CostMapEqualizer::noiseDeviations() const {
    return std::sqrt(2 * std::log(std::max(2., static_cast<double>(seconds_.size()))));
}

void CostMapEqualizer::endRest() {
    isVarying_ = restedFrames_ < kCalmFrames && (isChanged_ || isVarying_);
    isResting_ = isChanged_ = false;
    patience_ = isVarying_ ? std::min(4 * patience_, kMostPatience) : kFirstPatience;
    followedFrames_ = 0;
    memory_.clear();
}

void CostMapEqualizer::rest(const char* why) {
    isResting_ = true;
    isChanged_ = false;
    restedFrames_ = 0;
    decision_.what = why;
}

// Returns true if the resources differ from those of the current cuts by more than learning changes them.
bool CostMapEqualizer::isOtherUsage(const std::vector<double>& usage) {
    if (usage_.size() != usage.size()) usage_.assign(usage.size(), 1); // the even split
    for (size_t i = 0; i < usage.size(); ++i)
        if ((usage[i] > 0) != (usage_[i] > 0) || std::abs(usage[i] - usage_[i]) > kOtherUsage) return true;
    return false;
}

bool CostMapEqualizer::split(const FrameContext&, const CutRules& rules) {
    SplitTree other = tree_;
    cut(other, 0, {}, rules);
    const std::vector<Part> now = tree_.parts();
    const double longest = longestOf(now), promised = longestOf(other.parts());
    const double gain = longest > 0 ? 1 - promised / longest : 0;
    const double least =
        isVarying_ ? .5 * noiseGain()
                   : std::max(parameters_.number("gain"), noiseGain() * (1.6 + noiseDeviations()) / noiseDeviations());
    decision_.inputs = {{"longest", longest}, {"promised", promised}, {"noise", watch_.noise()}, {"threshold", least}};
    decision_.predictedGain = gain;
    if (isOtherUsage(rules.usage)) { // resources came, left or changed
        endRest();
        isVarying_ = false;
        tree_ = std::move(other);
        usage_ = rules.usage;
        decision_.what = "cuts moved to other resources";
        return true;
    }
    const double lost = isVarying_ ? 1.25 * noiseGain() : std::max(kGainToWake, 2.5 * noiseGain());
    if (isResting_ && (isChanged_ || (watch_.frames() >= kFramesToWake && gain > lost))) endRest();
    if (isResting_) {
        decision_.what = "rests: the load is constant";
        return false;
    }
    if (followedFrames_++ >= patience_) {
        rest("rests to see whether the load changes");
        return false;
    }
    if (!watch_.isNoiseKnown() && gain < kUnknownNoise * noiseDeviations() && followedFrames_ <= kFirstPatience / 2) {
        decision_.what = "waits for frames that show the noise";
        return false;
    }
    if (gain > least) {
        tree_ = std::move(other);
        usage_ = rules.usage;
        decision_.what = "cuts moved to equal costs of the map";
        return true;
    }
    decision_.what = "no sufficient gain";
    if (watch_.frames() > kQuietFrames && isSame(drawn_, now)) rest("rests: no sufficient gain");
    return false;
}

} // namespace mural::balance
