#include "nodes/exchange/picture_composer.hpp"

#include <algorithm>

namespace mural {

using compositor::Step;

PictureComposer::PictureComposer(ComposerConfig config, PartRoutes& routes, Log log) : config_(std::move(config)), routes_(routes), log_(std::move(log)) {}

PixelViewport PictureComposer::compose(PicturePart& part, const FoldRule& rule) {
    const int64_t beganNs = monotonicNowNs();
    if (rows_ != part.id.box.h) {
        rows_ = part.id.box.h;
        steps_ = std::move(compositor::makeSchedule(config_.strategy, config_.ranks, rows_)[static_cast<size_t>(config_.rank)]);
    }
    FoldRule used = rule;
    using compositor::DepthFunction;
    if (config_.plant == "tie") used.function = rule.function == DepthFunction::Less ? DepthFunction::LessOrEqual : DepthFunction::Less;
    changed_ = {};
    for (const Step& step : steps_) {
        if (step.receives()) take(part, step, used, beganNs);
        else send(part, step, used);
    }
    return changed_;
}

void PictureComposer::send(const PicturePart& part, const Step& step, const FoldRule& rule) {
    if (lost_.contains(step.peer)) return;
    PlaneEncoder& encoder = encoders_[step.peer];
    if (const LinkTransfer t = routes_.takeTransfer(step.peer); t.bytes > 0) encoder.transferred(t.bytes, t.ns);
    if (auto sent = routes_.send(step.peer, packPart(part, step.rows, rule, encoder), Deadline::inMs(config_.partMs)); !sent) lost(step.peer, sent.error().message);
}

void PictureComposer::take(PicturePart& part, const Step& step, const FoldRule& rule, int64_t beganNs) {
    if (lost_.contains(step.peer)) return;
    const Deadline deadline = Deadline::at(beganNs + (config_.partMs + config_.stageMs * step.stage) * kNsPerMs);
    auto message = routes_.receive(step.peer, boundBytesOf(part.id.box, step.rows), deadline);
    if (!message) return lost(step.peer, message.error().message);
    Step::Kind kind = step.kind;
    // Faults on purpose: what others drew is lost, a band is, the order of draws is swapped.
    if (config_.plant == "range" || (config_.plant == "band" && kind == Step::Kind::Place && step.peer == config_.ranks - 1)) return;
    if (config_.plant == "order" && kind != Step::Kind::Place) kind = kind == Step::Kind::FoldLater ? Step::Kind::FoldEarlier : Step::Kind::FoldLater;
    const auto done = unpackPart(*message, part.id, step.rows, rule, decoder_, [&](const ArrivedPiece& piece) { put(part, piece, kind, rule); });
    if (done) return;
    routes_.giveUp(step.peer);
    lost(step.peer, "range " + std::to_string(step.peer + 1) + ": " + done.error().message);
}

void PictureComposer::put(PicturePart& part, const ArrivedPiece& piece, Step::Kind kind, const FoldRule& rule) {
    const auto width = static_cast<size_t>(piece.area.w);
    for (int32_t y = 0; y < piece.area.h; ++y) {
        const size_t to = part.at(piece.area.x, piece.area.y + y), from = static_cast<size_t>(y) * width;
        if (kind == Step::Kind::Place) {
            std::copy_n(piece.colour + from, width, part.colour.data() + to);
            std::copy_n(piece.depth + from, width, part.depth.data() + to);
        } else {
            foldRow({part.colour.data() + to, part.depth.data() + to, piece.colour + from, piece.depth + from, width}, kind == Step::Kind::FoldLater ? FoldSide::Later : FoldSide::Earlier, rule);
        }
    }
    changed_ = unite(changed_, piece.area);
}

void PictureComposer::lost(int rank, const std::string& why) {
    if (lost_.insert(rank).second) log_("a range of the picture is missing from now on: " + why);
}

} // namespace mural
