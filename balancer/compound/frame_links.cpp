// Links output frames to input frames by name, within one tree and eye, and computes the place of each picture.
#include <algorithm>

#include "balancer/compound/planner.hpp"
#include "balancer/compound/tiles.hpp"

namespace mural::compound {

namespace {

Index pipeOf(const ResolvedConfig& config, Index channel) {
    return config.windows[at(config.channels[at(channel)].window)].pipe;
}

int32_t scaled(int32_t size, double by) { return std::max(1, static_cast<int32_t>(std::lround(size * by))); }

// A pixel kernel relative to another kernel. Incompatible kernels reduce to one pixel per block.
struct RelativeAxis {
    int32_t kernel, step;
};
RelativeAxis relative(const PixelAxis& of, const PixelAxis& to) {
    if (of.step % to.step != 0 || (of.kernel - to.kernel) % to.step != 0 || of.kernel < to.kernel) return {0, 1};
    return {(of.kernel - to.kernel) / to.step, of.step / to.step};
}

// Returns the consumer's pixel position of the first pixel of a picture that begins `offset` pixels into the producer's
// context.
double placeOf(const PixelAxis& giver, int32_t offset, const PixelAxis& taker) {
    const double destination = giver.origin + giver.scale * giver.step * offset; // of the containing block
    return (destination - taker.origin) / (taker.scale * taker.step);
}

const CompoundState& changesOf(const FrameInput& input, Index compound) {
    static const CompoundState kUnchanged;
    return at(compound) < input.compounds.size() ? input.compounds[at(compound)] : kUnchanged;
}

} // namespace

void Planner::linkFrames(Eye eye) {
    offers_.clear();
    outputs_.assign(active_.size(), {});
    inputs_.assign(active_.size(), {});
    const size_t first = plan_.frames.size();
    for (const ActiveCompound& a : active_) {
        if (a.tasks.has(Task::Readback)) offerFrames(a, eye);
    }
    for (const ActiveCompound& a : active_) {
        if (a.tasks.has(Task::Assemble)) takeFrames(a);
    }
    // Frames without a consumer are not read back.
    for (auto& outputs : outputs_) {
        std::erase_if(outputs, [&](Index f) { return plan_.frames[at(f)].consumers.empty(); });
    }
    // Channels that only assemble are not cleared for eyes without an input frame.
    for (size_t i = 0; i < active_.size(); ++i) {
        const bool shows =
            active_[i].tasks.has(Task::Assemble) && config_.compounds[at(active_[i].compound)].isGenerated;
        if (shows && inputs_[i].empty()) active_[i].tasks = {};
    }
    dropUnused(first);
}

// Removes frames without a consumer and renumbers the references to later frames.
void Planner::dropUnused(size_t first) {
    std::vector<Index> now(plan_.frames.size() - first, kNone);
    size_t retained = first;
    for (size_t f = first; f < plan_.frames.size(); ++f) {
        if (plan_.frames[f].consumers.empty()) continue;
        now[f - first] = static_cast<Index>(retained);
        if (retained != f) plan_.frames[retained] = std::move(plan_.frames[f]);
        ++retained;
    }
    plan_.frames.resize(retained);
    for (auto& outputs : outputs_) {
        for (Index& f : outputs) f = now[at(f) - first];
    }
    for (auto& inputs : inputs_) {
        for (FrameUse& use : inputs) use.frame = now[at(use.frame) - first];
    }
}

void Planner::offerFrames(const ActiveCompound& active, Eye eye) {
    const config::ResolvedCompound& c = config_.compounds[at(active.compound)];
    const Inherited& i = active.inherited;
    const RenderContext& context = plan_.contexts[at(active.context)];
    for (const config::ResolvedFrame& f : c.outputFrames) {
        if (offers_.contains(f.name)) continue; // the first definition counts; the check of the file reports duplicates
        PlannedFrame frame;
        frame.name = f.name;
        frame.compound = active.compound;
        frame.channel = i.executing;
        frame.eye = eye;
        frame.type = f.type;
        frame.buffers = f.buffers.value_or(i.buffers);
        frame.codec = f.codec;
        frame.exact = f.exact;
        frame.area = intersect(context.viewport, apply(context.viewport, f.viewport));
        if (frame.area.empty() || frame.buffers.empty()) continue;
        // A picture drawn larger than shown is scaled down before transfer. Textures stay in place and keep their size.
        if (f.type == config::FrameType::Memory) {
            const Zoom wanted = f.zoom.value_or(Zoom{1 / i.zoom.x, 1 / i.zoom.y});
            frame.zoom = {std::min(1., wanted.x), std::min(1., wanted.y)};
        }
        frame.size = {scaled(frame.area.w, frame.zoom.x), scaled(frame.area.h, frame.zoom.y)};
        // rounded to whole pixels
        frame.zoom = {frame.size.w / double(frame.area.w), frame.size.h / double(frame.area.h)};
        frame.range = i.range;
        frame.pixel = i.pixel;
        frame.subPixel = i.subPixel;
        frame.perTile = !c.inputQueues.empty();
        offers_[f.name] = {activeOf_[at(active.compound)], static_cast<Index>(plan_.frames.size())};
        outputs_[activeOf_[at(active.compound)]].push_back(static_cast<Index>(plan_.frames.size()));
        plan_.frames.push_back(std::move(frame));
    }
}

void Planner::takeFrames(const ActiveCompound& active) {
    for (const config::ResolvedFrame& wanted : config_.compounds[at(active.compound)].inputFrames) {
        const auto offer = offers_.find(wanted.name);
        if (offer == offers_.end()) continue; // no producer in this frame: the consumer does not wait
        PlannedFrame& frame = plan_.frames[at(offer->second.frame)];
        FrameUse use;
        use.frame = offer->second.frame;
        use.codec = wanted.codec != "auto" ? wanted.codec : frame.codec;
        use.exact = wanted.exact && frame.exact;
        placeFrame(active, wanted, active_[offer->second.active], frame, use);
        frame.consumers.push_back(active.inherited.executing);
        if (pipeOf(config_, frame.channel) != pipeOf(config_, active.inherited.executing))
            frame.type = config::FrameType::Memory;
        inputs_[activeOf_[at(active.compound)]].push_back(std::move(use));
    }
}

void Planner::placeFrame(const ActiveCompound& taker, const config::ResolvedFrame& wanted, const ActiveCompound& giver,
                         const PlannedFrame& frame, FrameUse& use) const {
    const RenderContext& to = plan_.contexts[at(taker.context)];
    const RenderContext& from = plan_.contexts[at(giver.context)];
    use.clip = intersect(to.viewport, apply(to.viewport, wanted.viewport));
    if (giver.inherited.destination != taker.inherited.destination) {
        const auto& placements = changesOf(input_, taker.compound).inputs;
        const auto index = static_cast<size_t>(&wanted - config_.compounds[at(taker.compound)].inputFrames.data());
        if (!wanted.zoom && index < placements.size() && placements[index]) {
            const InputPlacement& place = *placements[index];
            const PixelViewport& whole = from.viewport;
            use.x =
                to.viewport.x + place.x + static_cast<int32_t>(std::lround((frame.area.x - whole.x) * place.zoom.x));
            use.y =
                to.viewport.y + place.y + static_cast<int32_t>(std::lround((frame.area.y - whole.y) * place.zoom.y));
            use.zoom = {place.zoom.x / frame.zoom.x, place.zoom.y / frame.zoom.y};
            return;
        }
        // A mirror of another channel: scaled to this channel's size.
        use.x = to.viewport.x;
        use.y = to.viewport.y;
        use.zoom =
            wanted.zoom.value_or(Zoom{to.viewport.w / double(frame.size.w), to.viewport.h / double(frame.size.h)});
        return;
    }
    const RelativeAxis x = relative(giver.inherited.x, taker.inherited.x),
                       y = relative(giver.inherited.y, taker.inherited.y);
    use.kernel = {x.kernel, y.kernel, x.step, y.step};
    use.x = to.viewport.x + static_cast<int32_t>(std::lround(placeOf(from.x, frame.area.x - from.viewport.x, to.x)));
    use.y = to.viewport.y + static_cast<int32_t>(std::lround(placeOf(from.y, frame.area.y - from.viewport.y, to.y)));
    const Zoom inherited{from.x.scale / to.x.scale, from.y.scale / to.y.scale};
    const Zoom own = wanted.zoom ? Zoom{wanted.zoom->x / from.zoom.x, wanted.zoom->y / from.zoom.y} : inherited;
    use.zoom = {own.x / frame.zoom.x, own.y / frame.zoom.y};
}

void Planner::addQueues() {
    queues_.clear();
    for (const ActiveCompound& a : active_) {
        if (a.context == kNone) continue;
        for (const config::ResolvedQueue& q : config_.compounds[at(a.compound)].outputQueues) {
            if (queues_.contains(q.name)) continue;
            queues_[q.name] = static_cast<Index>(plan_.queues.size());
            plan_.queues.push_back({q.name, a.context, tilesOf(plan_.contexts[at(a.context)].area, q.size)});
        }
    }
}

} // namespace mural::compound
