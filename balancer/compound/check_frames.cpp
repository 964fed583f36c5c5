#include "balancer/compound/check_frames.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "balancer/compound/even_split.hpp"
#include "balancer/compound/inheritance.hpp"

namespace mural::compound {

namespace {

// A compound with its inherited attributes before equalizers change them.
struct Known {
    Index compound = kNone;
    Inherited inherited;
    bool assembles = false;
    bool readsBack = false;
};

void gather(const ResolvedConfig& config, const FrameInput& input, Index compound, const Inherited* above,
            std::vector<Known>& all) {
    const config::ResolvedCompound& c = config.compounds[at(compound)];
    Known known{compound, inherit(config, input, compound, above), false, false};
    const auto tasks = c.tasks.value_or(config::TaskSet{config::Task::Assemble, config::Task::Readback});
    known.assembles = tasks.has(config::Task::Assemble);
    known.readsBack = tasks.has(config::Task::Readback);
    all.push_back(known);
    const Inherited own = known.inherited;
    for (const Index child : c.children) gather(config, input, child, &own, all);
}

// Returns true if both compounds are active in the same frame for the same eye at least once.
bool everTogether(const Inherited& a, const Inherited& b) {
    const EyeSet eyes = a.eyes.value_or(kAllEyes) & b.eyes.value_or(kAllEyes);
    const uint32_t common = std::gcd(a.period, b.period);
    return !eyes.empty() && a.phase % common == b.phase % common;
}

class TreeCheck {
public:
    TreeCheck(const ResolvedConfig& config, const std::vector<Known>& all, config::Diagnostics& diagnostics)
        : config_(config), all_(all), diagnostics_(diagnostics) {}

    void run() {
        for (const Known& k : all_) {
            const config::ResolvedCompound& c = config_.compounds[at(k.compound)];
            for (const config::ResolvedFrame& f : c.outputFrames) checkOutput(k, f);
            for (const config::ResolvedFrame& f : c.inputFrames) checkInput(k, f);
            for (const config::ResolvedQueue& q : c.inputQueues) checkInputQueue(q);
            for (const config::ResolvedQueue& q : c.outputQueues) checkOutputQueue(q);
        }
    }

private:
    void checkOutput(const Known& maker, const config::ResolvedFrame& frame) {
        bool taken = false;
        for (const Known& other : all_) {
            const config::ResolvedCompound& c = config_.compounds[at(other.compound)];
            const auto named = [&](const config::ResolvedFrame& f) { return f.name == frame.name; };
            taken = taken || std::any_of(c.inputFrames.begin(), c.inputFrames.end(), named);
            if (other.compound >= maker.compound || !other.readsBack || !maker.readsBack ||
                !everTogether(other.inherited, maker.inherited))
                continue;
            if (std::any_of(c.outputFrames.begin(), c.outputFrames.end(), named)) {
                diagnostics_.warn(
                    frame.at, "frame \"" + frame.name + "\" is defined twice in this tree, only the first one is used",
                    "rename one of them");
            }
        }
        if (!taken)
            diagnostics_.warn(frame.at,
                              "no compound of this tree uses frame \"" + frame.name + "\", it is not read back",
                              "add an inputframe of that name, or remove it");
        else if (!maker.readsBack)
            diagnostics_.warn(frame.at,
                              "frame \"" + frame.name + "\" is never created: the tasks of its compound lack READBACK",
                              "add READBACK to the tasks");
    }

    void checkInput(const Known& taker, const config::ResolvedFrame& frame) {
        const Known* maker = nullptr;
        bool together = false;
        for (const Known& other : all_) {
            const auto& outputs = config_.compounds[at(other.compound)].outputFrames;
            const auto found = std::find_if(outputs.begin(), outputs.end(),
                                            [&](const config::ResolvedFrame& f) { return f.name == frame.name; });
            if (found == outputs.end()) continue;
            maker = &other;
            if (!everTogether(other.inherited, taker.inherited)) continue;
            together = true;
            checkTexture(taker, other, *found, frame);
        }
        if (maker == nullptr)
            diagnostics_.warn(frame.at, "no compound of this tree creates frame \"" + frame.name + "\", it is ignored",
                              "add an outputframe of that name, or remove it");
        else if (!together)
            diagnostics_.warn(frame.at,
                              "frame \"" + frame.name +
                                  "\" is never created for the eyes and frame numbers that use it, it is ignored",
                              "make eyes, periods and phases of both agree");
        else if (!taker.assembles)
            diagnostics_.warn(frame.at,
                              "frame \"" + frame.name + "\" is not used: the tasks of this compound lack ASSEMBLE",
                              "add ASSEMBLE to the tasks");
    }

    void checkTexture(const Known& taker, const Known& maker, const config::ResolvedFrame& made,
                      const config::ResolvedFrame& frame) {
        if (made.type != config::FrameType::Texture || taker.inherited.executing == kNone ||
            maker.inherited.executing == kNone)
            return;
        const auto pipeOf = [&](const Known& k) {
            return config_.windows[at(config_.channels[at(k.inherited.executing)].window)].pipe;
        };
        if (pipeOf(taker) != pipeOf(maker))
            diagnostics_.warn(frame.at,
                              "frame \"" + frame.name +
                                  "\" is a texture, but another pipe uses it, it is transferred through memory",
                              "use type memory, or channels of one pipe");
    }

    void checkInputQueue(const config::ResolvedQueue& queue) {
        const bool filled = std::any_of(all_.begin(), all_.end(), [&](const Known& k) {
            const auto& queues = config_.compounds[at(k.compound)].outputQueues;
            return std::any_of(queues.begin(), queues.end(),
                               [&](const config::ResolvedQueue& q) { return q.name == queue.name; });
        });
        if (!filled)
            diagnostics_.error(queue.at, "no compound of this tree fills the queue \"" + queue.name + "\"",
                               "add outputtiles of that name to a compound");
    }

    void checkOutputQueue(const config::ResolvedQueue& queue) {
        const bool sized = (queue.size.pixels && queue.size.pixels->x > 0 && queue.size.pixels->y > 0) ||
                           (queue.size.range && *queue.size.range > 0);
        if (!sized)
            diagnostics_.error(queue.at, "the queue \"" + queue.name + "\" has no size",
                               "set size [ width height ] in pixels, or size as a fraction of the range");
    }

    const ResolvedConfig& config_;
    const std::vector<Known>& all_;
    config::Diagnostics& diagnostics_;
};

} // namespace

void checkFrames(const ResolvedConfig& config, config::Diagnostics& diagnostics) {
    const FrameInput input = firstFrame(config);
    for (const Index root : config.roots) {
        std::vector<Known> all;
        gather(config, input, root, nullptr, all);
        TreeCheck(config, all, diagnostics).run();
        for (const Known& k : all) {
            if (k.inherited.phase >= k.inherited.period && config.compounds[at(k.compound)].phase) {
                const std::string phase = std::to_string(k.inherited.phase),
                                  period = std::to_string(k.inherited.period);
                diagnostics.warn(config.compounds[at(k.compound)].at,
                                 "phase " + phase + " does not occur with a period of " + period +
                                     ", so this compound never draws",
                                 "choose a phase below the period");
            }
        }
    }
}

} // namespace mural::compound
