// Draws compound trees: a box per compound with its attributes and tasks, and arrows for frames.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "balancer/config/eqc/section_fields.hpp"
#include "balancer/svg/sections.hpp"

namespace mural::drawing {

namespace {

using config::ResolvedCompound;
using config::Task;

constexpr double kBoxWidth = 150, kBoxGap = 18, kLine = 13, kLevel = 62, kTop = 24;

std::string fraction(double value) { return fmt::format("{:.3g}", value); }

// Returns the attributes that a compound sets itself, one line each.
std::vector<std::string> wordsOf(const ResolvedCompound& c) {
    std::vector<std::string> words;
    if (!c.viewport.full())
        words.push_back(fmt::format("viewport {} {} {} {}", fraction(c.viewport.x), fraction(c.viewport.y),
                                    fraction(c.viewport.w), fraction(c.viewport.h)));
    if (!c.range.full()) words.push_back(fmt::format("range {} to {}", fraction(c.range.start), fraction(c.range.end)));
    if (!c.pixel.whole())
        words.push_back(fmt::format("pixel {} {} of {} x {}", c.pixel.x, c.pixel.y, c.pixel.w, c.pixel.h));
    if (!c.subPixel.whole()) words.push_back(fmt::format("sample {} of {}", c.subPixel.index, c.subPixel.size));
    if (c.period) words.push_back(fmt::format("frames {}, every {}", c.phase.value_or(0), *c.period));
    if (c.eyes && !(*c.eyes == kAllEyes)) {
        std::string eyes = "eyes";
        for (const Eye eye : kEyes)
            eyes += c.eyes->has(eye) ? std::string(" ") + (eye == Eye::Left    ? "left"
                                                           : eye == Eye::Right ? "right"
                                                                               : "cyclop")
                                     : "";
        words.push_back(eyes);
    }
    if (!c.zoom.none()) words.push_back(fmt::format("zoom {} {}", fraction(c.zoom.x), fraction(c.zoom.y)));
    for (const auto& e : c.equalizers)
        words.emplace_back(std::visit([](const auto& one) { return std::string(config::sectionName(one)); }, e));
    for (const auto& q : c.outputQueues) words.push_back("fills " + q.name);
    for (const auto& q : c.inputQueues) words.push_back("takes from " + q.name);
    if (c.barrier) words.push_back("waits at " + c.barrier->name);
    return words;
}

// Returns the tasks as the planner decides them, regardless of active layouts.
config::TaskSet tasksOf(const ResolvedConfig& config, const ResolvedCompound& c) {
    if (c.executing == kNone) return {};
    config::TaskSet tasks = c.tasks.value_or(config::TaskSet{Task::Clear, Task::Draw, Task::Assemble, Task::Readback});
    for (Index up = c.parent; up != kNone && !c.tasks && c.isLeaf(); up = config.compounds[at(up)].parent) {
        if (config.compounds[at(up)].executing == c.executing) tasks.remove(Task::Clear);
    }
    if (!c.isLeaf()) tasks.remove(Task::Draw);
    if (c.inputFrames.empty()) tasks.remove(Task::Assemble);
    if (c.outputFrames.empty()) tasks.remove(Task::Readback);
    return tasks;
}

double heightOf(const ResolvedConfig& config, const ResolvedCompound& c) {
    const double lines = kLine * static_cast<double>(wordsOf(c).size());
    return kTop + lines + (tasksOf(config, c).empty() ? lines > 0 ? 4 : -2 : 19);
}

std::string titleOf(const ResolvedConfig& config, const ResolvedCompound& c) {
    if (c.channel != kNone) {
        const config::ResolvedChannel& channel = config.channels[at(c.channel)];
        if (channel.isDestination()) {
            const config::ResolvedView& v = config.views[at(channel.view)];
            const config::ResolvedLayout& layout = config.layouts[at(v.layout)];
            std::string where = layout.name;
            if (layout.views.size() > 1) {
                const auto number = static_cast<size_t>(
                    std::find(layout.views.begin(), layout.views.end(), channel.view) - layout.views.begin());
                where += (where.empty() ? "" : ", ") + nameOr(v.name, "view", number);
            }
            return channel.name + (where.empty() ? "" : " (" + where + ")");
        }
        return channel.name;
    }
    return !c.name.empty() ? c.name : c.executing == kNone ? "group" : "here";
}

// Layout of one tree, top down: leaves side by side, inner nodes centred above their children.
class Tree {
public:
    Tree(const ResolvedConfig& config, Index root) : config_(config), root_(root) { place(root, 0, 0); }

    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double height() const { return height_ + below_; }

    void draw(Svg& svg, Point corner) {
        for (auto& [index, box] : boxes_) {
            box.x += corner.x;
            box.y += corner.y;
        }
        drawEdges(svg, root_);
        drawFrames(svg);
        for (const auto& [index, box] : boxes_) drawBox(svg, config_.compounds[at(index)], box);
    }

private:
    // Places the subtree and returns the centre of its root's box.
    double place(Index index, double x, double y) {
        const ResolvedCompound& c = config_.compounds[at(index)];
        const double h = heightOf(config_, c);
        height_ = std::max(height_, y + h);
        double middle = x + kBoxWidth / 2;
        if (!c.children.empty()) {
            double childX = x, first = 0, last = 0;
            for (size_t i = 0; i < c.children.size(); ++i) {
                last = place(c.children[i], childX, y + h + kLevel);
                if (i == 0) first = last;
                childX = std::max(childX, extent_) + kBoxGap;
            }
            middle = (first + last) / 2;
        }
        boxes_[index] = {middle - kBoxWidth / 2, y, kBoxWidth, h};
        extent_ = std::max(extent_, middle + kBoxWidth / 2);
        if (c.children.empty()) extent_ = std::max(extent_, x + kBoxWidth);
        width_ = std::max(width_, extent_);
        for (const auto& f : c.outputFrames) {
            makers_[f.name].push_back(index);
            ++frames_;
        }
        for (const auto& f : c.inputFrames) takers_[f.name].push_back(index);
        below_ = isExchanging() ? 72 : 10; // room for the arrows below
        return middle;
    }

    // Returns true if a frame does not lead straight up.
    [[nodiscard]] bool isExchanging() const {
        for (const auto& [name, makers] : makers_) {
            const auto takers = takers_.find(name);
            if (takers == takers_.end()) continue;
            for (const Index maker : makers) {
                for (const Index taker : takers->second) {
                    if (!isAbove(taker, maker)) return true;
                }
            }
        }
        return false;
    }

    [[nodiscard]] bool isAbove(Index above, Index index) const {
        for (Index up = config_.compounds[at(index)].parent; up != kNone; up = config_.compounds[at(up)].parent) {
            if (up == above) return true;
        }
        return false;
    }

    void drawEdges(Svg& svg, Index index) const {
        const Box& box = boxes_.at(index);
        for (const Index child : config_.compounds[at(index)].children) {
            const Box& to = boxes_.at(child);
            const double y = box.bottom() + 14;
            svg.line({box.x + box.w / 2, box.bottom()}, {box.x + box.w / 2, y},
                     {.stroke = "#cbd2d9", .strokeWidth = 1.5, .dash = {}});
            svg.line({box.x + box.w / 2, y}, {to.x + to.w / 2, y},
                     {.stroke = "#cbd2d9", .strokeWidth = 1.5, .dash = {}});
            svg.line({to.x + to.w / 2, y}, {to.x + to.w / 2, to.y},
                     {.stroke = "#cbd2d9", .strokeWidth = 1.5, .dash = {}});
            drawEdges(svg, child);
        }
    }

    // Number of arrows that enter each compound, and that leave it upwards and downwards.
    struct Ports {
        std::map<Index, double> in, up, down;
    };

    // An arrow to an ancestor leads from the producer's top to the consumer's bottom. Other arrows lead below both
    // boxes.
    void drawFrames(Svg& svg) const {
        Ports ports;
        const bool few = frames_ <= 24;
        for (const auto& [name, makers] : makers_) {
            const auto takers = takers_.find(name);
            if (takers == takers_.end()) continue;
            for (const Index maker : makers) {
                for (const Index taker : takers->second) drawFrame(svg, name, maker, taker, ports, few);
            }
        }
    }

    void drawFrame(Svg& svg, const std::string& name, Index maker, Index taker, Ports& ports, bool named) const {
        const Box& from = boxes_.at(maker);
        const Box& to = boxes_.at(taker);
        double incoming = 0; // number of arrows
        for (const auto& f : config_.compounds[at(taker)].inputFrames) {
            if (const auto all = makers_.find(f.name); all != makers_.end())
                incoming += static_cast<double>(all->second.size());
        }
        const std::string color = colorOf(config_, config_.compounds[at(maker)].executing);
        const Style style{.stroke = color, .strokeWidth = named ? 1.6 : 1, .dash = {}, .opacity = named ? .95 : .6};
        const std::string tip = "frame " + name;
        if (taker == maker || isAbove(taker, maker)) {
            const double x = from.x + from.w / 2 + 22 + 9 * ports.up[maker],
                         port = to.x + to.w * (.5 + .44 * (ports.in[taker]++ + 1) / (incoming + 1));
            const double label = from.y - 5 - 10 * ports.up[maker]++;
            const double reach = std::max(22., (from.y - to.bottom()) * .6);
            svg.arrow({x, from.y}, {x, from.y - reach}, {port, to.bottom() + reach}, {port, to.bottom()}, style, tip);
            if (named) svg.text({x + 5, label}, name, {8.5, color, false, Align::Left}, kBoxWidth / 2 - 20);
            return;
        }
        const double x = from.x + 22 + 11 * ports.down[maker],
                     port = to.x + to.w * (.1 + .35 * (ports.in[taker]++ + 1) / (incoming + 1));
        const double label = from.bottom() + 10 + 10 * ports.down[maker]++;
        const double depth = std::clamp(16 + std::abs(port - x) * .12, 20., 80.);
        const double low = std::max(from.bottom(), to.bottom()) + depth;
        svg.arrow({x, from.bottom()}, {x, low}, {port, low}, {port, to.bottom()}, style, tip);
        if (named) svg.text({x + 4, label}, name, {8.5, color, false, Align::Left}, kBoxWidth * .6);
    }

    void drawBox(Svg& svg, const ResolvedCompound& c, const Box& box) const {
        const std::string color = colorOf(config_, c.executing);
        svg.rect(box,
                 {.fill = "#ffffff",
                  .stroke = color,
                  .strokeWidth = c.channel != kNone && c.channel == c.destination ? 2.2 : 1.2,
                  .rounding = 5,
                  .dash = c.isGenerated ? "4 3" : ""},
                 c.isGenerated ? "not in the file: created for the canvases" : "");
        svg.rect({box.x, box.y, box.w, kTop - 4},
                 {.fill = paleColorOf(config_, c.executing), .rounding = 5, .dash = {}});
        svg.text({box.x + box.w / 2, box.y + 14}, titleOf(config_, c),
                 {11, "#111820", c.channel != kNone, Align::Middle}, box.w - 10);
        double y = box.y + kTop + 8;
        for (const std::string& word : wordsOf(c)) {
            svg.text({box.x + 8, y}, word, {9.5, "#3e4c59", false, Align::Left}, box.w - 14);
            y += kLine;
        }
        drawTasks(svg, c, {box.x + 8, box.bottom() - 17});
    }

    void drawTasks(Svg& svg, const ResolvedCompound& c, Point corner) const {
        const config::TaskSet tasks = tasksOf(config_, c);
        double x = corner.x;
        for (const auto& [task, word] : {std::pair(Task::Clear, "clear"),
                                         {Task::Draw, "draw"},
                                         {Task::Assemble, "join"},
                                         {Task::Readback, "read"}}) {
            if (!tasks.has(task)) continue;
            const bool draws = task == Task::Draw;
            const double w = Svg::widthOf(word, 8.5) + 8;
            svg.rect({x, corner.y, w, 12}, {.fill = draws ? "#323f4b" : "#e4e7eb", .rounding = 6, .dash = {}});
            svg.text({x + w / 2, corner.y + 9}, word, {8.5, draws ? "#ffffff" : "#3e4c59", false, Align::Middle});
            x += w + 3;
        }
    }

    const ResolvedConfig& config_;
    Index root_;
    std::map<Index, Box> boxes_;
    std::map<std::string, std::vector<Index>> makers_, takers_;
    size_t frames_ = 0;
    double extent_ = 0, width_ = 0, height_ = 0, below_ = 0;
};

} // namespace

Box drawCompounds(Svg& svg, const ResolvedConfig& config, Point corner, double width) {
    constexpr double kTreeGap = 46;
    double x = corner.x, y = corner.y, row = 0, right = corner.x + 780;
    svg.text({x, y + 2},
             "clear, draw, join (assemble), read (back): tasks of a box; arrows: transferred pictures; thick borders: "
             "shown pictures; dashed: not in the file",
             {10, "#7b8794", false, Align::Left});
    y += 18;
    for (const Index root : config.roots) {
        Tree tree(config, root);
        if (x > corner.x && x + tree.width() > corner.x + width) {
            x = corner.x;
            y += row + 26;
            row = 0;
        }
        tree.draw(svg, {x, y});
        row = std::max(row, tree.height());
        right = std::max(right, x + tree.width());
        x += tree.width() + kTreeGap;
    }
    return {corner.x, corner.y, right - corner.x, y + row - corner.y};
}

} // namespace mural::drawing
