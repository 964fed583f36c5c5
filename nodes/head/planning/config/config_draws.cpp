#include "nodes/head/planning/config/config_draws.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "balancer/compound/frusta.hpp"
#include "balancer/compound/plan_frame.hpp"

namespace mural {
namespace {

using compound::FramePlan;
using compound::RenderContext;
using config::at;
using config::Index;
using config::kNone;

constexpr uint32_t kMaxTurns = 64; // bounds periods without a small common multiple

// Returns the number of frames after which the draws repeat.
uint32_t periodOf(const config::ResolvedConfig& config) {
    uint32_t period = 1;
    for (const config::ResolvedCompound& c : config.compounds) {
        const uint32_t own = std::max<uint32_t>(1, c.period.value_or(1));
        period = std::min(kMaxTurns, std::lcm(period, std::min(own, kMaxTurns)));
    }
    return period;
}

// Divides the picture or the range into equal strips, one per worker of the queue, in the order of the tree. The
// queue's equalizer divides in this order, too: the ranks of ranges never change.
void dealOut(const ConfigSource& source, const FramePlan& frame, const compound::PlannedQueue& queue,
             std::vector<ConfigDraw*> workers, SessionPlan& plan) {
    std::ranges::sort(workers, {}, [](const ConfigDraw* d) { return d->context.compound; });
    const RenderContext& divided = frame.contexts[at(queue.context)];
    const bool chunks =
        !queue.tiles.empty() && std::any_of(queue.tiles.begin(), queue.tiles.end(),
                                            [&](const compound::PlannedTile& t) { return t.range != divided.range; });
    const double n = static_cast<double>(workers.size());
    for (size_t i = 0; i < workers.size(); ++i) {
        const double from = static_cast<double>(i) / n, to = static_cast<double>(i + 1) / n;
        const Viewport whole = compose(source.config.views[at(divided.view)].viewport, divided.part);
        workers[i]->area = chunks ? whole : compose(whole, Viewport{0, from, 1, to - from});
        workers[i]->context.range = chunks ? compose(divided.range, Range{from, to}) : divided.range;
    }
    if (queue.tiles.empty() || !workers.front()->flow.ignored) return;
    plan.warnings.push_back(source.placeOf(workers.front()->context.compound) + ": pixels of queue \"" + queue.name +
                            "\" are shown at their drawn position and size; viewport and zoom of its frames are "
                            "ignored; remove them, or divide the picture without a queue");
}

class DrawGatherer {
public:
    DrawGatherer(const ConfigSource& source, SessionPlan& plan) : source_(source), plan_(plan) {}

    void addFrame(const compound::FrameInput& input) {
        const FramePlan frame = compound::planFrame(source_.config, input);
        const std::vector<compound::Flow> flows = compound::flowOf(source_.config, input, frame);
        for (const compound::ShownCopy& copy : compound::copiesOf(source_.config, input, frame)) addCopy(copy, frame);
        for (const compound::PlannedBarrier& barrier : frame.barriers)
            for (const Index window : barrier.windows) found_.barriers.try_emplace(window, barrier.name);
        std::map<Index, std::vector<size_t>> workers; // draws by queue
        for (const compound::ChannelPlan& channel : frame.channels)
            for (const compound::PlannedTask& task : channel.tasks)
                if (addTask(task, frame, flows) && task.queue != kNone)
                    workers[task.queue].push_back(found_.draws.size() - 1);
        for (const auto& [queue, indices] : workers) {
            std::vector<ConfigDraw*> draws;
            for (const size_t i : indices) draws.push_back(&found_.draws[i]);
            dealOut(source_, frame, frame.queues[at(queue)], std::move(draws), plan_);
        }
    }

    ConfigDraws take() { return std::move(found_); }

private:
    // Returns false if the task is not a draw, or an earlier frame had it.
    bool addTask(const compound::PlannedTask& task, const FramePlan& frame, const std::vector<compound::Flow>& flows) {
        if (task.kind != config::Task::Draw || task.context == kNone) return false;
        const RenderContext& c = frame.contexts[at(task.context)];
        if (c.view == kNone || !seen_.emplace(c.compound, c.destination, c.view, c.eye).second) return false;
        ConfigDraw draw;
        draw.context = c;
        draw.area = compose(source_.config.views[at(c.view)].viewport, c.part);
        draw.flow = flows[at(task.context)];
        found_.draws.push_back(std::move(draw));
        return true;
    }

    [[nodiscard]] Index canvasOf(Index channel) const {
        const Index segment = source_.config.channels[at(channel)].segment;
        return segment == kNone ? kNone : source_.config.segments[at(segment)].canvas;
    }

    void addCopy(const compound::ShownCopy& shown, const FramePlan& frame) {
        const config::ResolvedConfig& config = source_.config;
        const RenderContext& c = frame.contexts[at(shown.context)];
        const config::ResolvedChannel& channel = config.channels[at(shown.channel)];
        if (c.view == kNone || channel.view == kNone) return;
        CanvasCopy copy;
        copy.source = canvasOf(c.destination);
        copy.from = compose(compose(config.views[at(c.view)].viewport, c.part), shown.from);
        copy.target = canvasOf(shown.channel);
        const Viewport place = compose(config.views[at(channel.view)].viewport, compound::coverage(config, channel));
        copy.to = compose(place, shown.to);
        if (copy.source != kNone && copy.target != kNone) found_.copies.push_back(copy);
    }

    const ConfigSource& source_;
    SessionPlan& plan_;
    ConfigDraws found_;
    std::set<std::tuple<Index, Index, Index, Eye>> seen_;
};

} // namespace

ConfigDraws gatherDraws(const ConfigSource& source, compound::FrameInput input, SessionPlan& plan) {
    DrawGatherer gatherer(source, plan);
    const uint32_t period = periodOf(source.config);
    for (uint32_t frame = 0; frame < period; ++frame) {
        input.frameNumber = frame;
        gatherer.addFrame(input);
    }
    return gatherer.take();
}

} // namespace mural
