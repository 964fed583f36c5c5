#include "nodes/exchange/picture_composer.hpp"

#include <algorithm>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/frame_spans/span_scope.hpp"

namespace mural {

using compositor::Step;
using compositor::Strategy;

namespace {

// FNV-1a. Never 0 for an order.
uint32_t hashOf(const std::vector<int>& order) {
    if (order.empty()) return 0;
    uint32_t hash = 2166136261u;
    for (const int rank : order) hash = (hash ^ static_cast<uint32_t>(rank)) * 16777619u;
    return std::max(hash, 1u);
}

} // namespace

PictureComposer::PictureComposer(ComposerConfig config, PartRoutes& routes)
    : config_(std::move(config)), strategy_(config_.strategy), routes_(routes) {}

// Receives the collector's decision for this picture: one byte, 1 for the serial strategy.
void PictureComposer::agree() {
    if (std::exchange(agreed_, false) || strategy_ == Strategy::Serial || config_.rank == 0 || lost_.contains(0))
        return;
    auto decision = receive(0, 1, Deadline::inMs(config_.decisionMs));
    if (!decision || decision->size() != 1)
        return lost(0, decision ? "range 1 sent an invalid strategy" : decision.error().message);
    if (decision->front() != std::byte{0}) serially();
}

Result<std::vector<std::byte>> PictureComposer::receive(int rank, size_t maxBytes, Deadline deadline) {
    const SpanScope waits(SpanKind::WaitPart);
    return routes_.receive(rank, maxBytes, deadline);
}

// After a loss, the remaining nodes send directly to the collector from the next picture on.
void PictureComposer::sendNext() {
    if (strategy_ == Strategy::Serial || config_.rank != 0) return;
    for (int rank = 1; rank < config_.ranks; ++rank)
        if (!lost_.contains(rank)) (void)routes_.send(rank, {std::byte{incomplete_}}, Deadline::inMs(config_.partMs));
    if (incomplete_) serially();
}

void PictureComposer::serially() {
    strategy_ = Strategy::Serial;
    rows_ = -1;
    log::debug(log::Topic::Exchange, "all ranges send to the collector from the next picture on");
}

void PictureComposer::returned(int rank, uint32_t incarnation, const std::set<int>& absent) {
    // discards a stale decision of the collector for the previous picture
    if (rank != 0 && rank != config_.rank) agree();
    if (rank != config_.rank) routes_.renew(rank, incarnation);
    encoders_.erase(rank); // codec choice depends on the bandwidth of the old link
    lost_ = absent;
    incomplete_ = false;
    agreed_ = true;
    strategy_ = absent.empty() ? config_.strategy : Strategy::Serial;
    rows_ = -1;
    log::debug(log::Topic::Exchange, "range ", rank + 1, " is back; strategy ", nameOf(strategy_));
}

PixelViewport PictureComposer::compose(PicturePart& part, const CompositeRule& rule, const std::vector<int>& order) {
    const SpanScope composes(SpanKind::Compose);
    agree();
    const int64_t beganNs = monotonicNowNs();
    if (rows_ != part.id.box.h || order_ != order) {
        rows_ = part.id.box.h;
        order_ = order;
        compositor::Schedule schedule = order.empty() ? compositor::makeSchedule(strategy_, config_.ranks, rows_)
                                                      : compositor::makeSchedule(strategy_, order, rows_);
        steps_ = std::move(schedule[static_cast<size_t>(config_.rank)]);
    }
    part.order = hashOf(order);
    CompositeRule used = rule;
    using compositor::DepthFunction;
    if (config_.plant == "tie")
        used.function = rule.function == DepthFunction::Less ? DepthFunction::LessOrEqual : DepthFunction::Less;
    changed_ = {};
    for (const Step& step : steps_) {
        if (step.receives())
            take(part, step, used, beganNs);
        else
            send(part, step, used);
    }
    sendNext();
    return changed_;
}

void PictureComposer::send(const PicturePart& part, const Step& step, const CompositeRule& rule) {
    if (lost_.contains(step.peer)) return;
    PlaneEncoder& encoder = encoders_.try_emplace(step.peer, config_.codec).first->second;
    if (const LinkTransfer t = routes_.takeTransfer(step.peer); t.bytes > 0) encoder.transferred(t.bytes, t.ns);
    if (auto sent = routes_.send(
            step.peer,
            packPart(part, step.rows, rule, incomplete_ ? PartState::Incomplete : PartState::Complete, encoder),
            Deadline::inMs(config_.partMs));
        !sent)
        lost(step.peer, sent.error().message);
}

void PictureComposer::take(PicturePart& part, const Step& step, const CompositeRule& rule, int64_t beganNs) {
    if (lost_.contains(step.peer)) return;
    const Deadline deadline = Deadline::at(beganNs + (config_.partMs + config_.stageMs * step.stage) * kNsPerMs);
    auto message = receive(step.peer, boundBytesOf(part.id.box, step.rows), deadline);
    if (!message) return lost(step.peer, message.error().message + hintAboutOrder());
    Step::Kind kind = step.kind;
    // Fault injection: drops the contributions of others, drops a band, or swaps the draw order.
    if (config_.plant == "range" ||
        (config_.plant == "band" && kind == Step::Kind::Place && step.peer == config_.ranks - 1))
        return;
    if (config_.plant == "order" && kind != Step::Kind::Place)
        kind = kind == Step::Kind::FoldLater ? Step::Kind::FoldEarlier : Step::Kind::FoldLater;
    auto done = unpackPart(*message, part.id, step.rows, rule, decoder_,
                           [&](const ArrivedPiece& piece) { put(part, piece, kind, rule); });
    if (done) {
        incomplete_ = incomplete_ || done->state == PartState::Incomplete;
        if (done->order != part.order) reportOrder(step.peer);
        return;
    }
    routes_.giveUp(step.peer);
    lost(step.peer, "range " + std::to_string(step.peer + 1) + ": " + done.error().message + hintAboutOrder());
}

void PictureComposer::reportOrder(int rank) {
    if (std::exchange(hasReportedOrder_, true)) return;
    log::warning(
        log::Topic::Exchange, "the nodes of ranges ", config_.rank + 1, " and ", rank + 1,
        " blend in different orders, so the picture is wrong; Renderer::order must return the same positions on "
        "all nodes");
}

// With strategies other than serial and direct-send, the order also selects the partners of a node. Different orders
// then let nodes wait for parts that others do not send.
std::string PictureComposer::hintAboutOrder() const {
    const bool ordersPartners = strategy_ != Strategy::Serial && strategy_ != Strategy::DirectSend;
    return order_.empty() || !ordersPartners ? ""
                                             : "; a Renderer::order that differs between nodes has this effect, too";
}

void PictureComposer::put(PicturePart& part, const ArrivedPiece& piece, Step::Kind kind, const CompositeRule& rule) {
    const auto width = static_cast<size_t>(piece.area.w), words = rule.colourWords();
    for (int32_t y = 0; y < piece.area.h; ++y) {
        const size_t to = part.at(piece.area.x, piece.area.y + y), from = static_cast<size_t>(y) * width;
        if (kind == Step::Kind::Place) {
            std::copy_n(piece.colour + from * words, width * words, part.colour.data() + to * words);
            if (!rule.blends) std::copy_n(piece.depth + from, width, part.depth.data() + to);
        } else {
            CompositeRow row{part.colour.data() + to * words, nullptr, piece.colour + from * words, nullptr, width};
            if (!rule.blends) {
                row.depth = part.depth.data() + to;
                row.otherDepth = piece.depth + from;
            }
            compositeRow(row, kind == Step::Kind::FoldLater ? LayerOrder::Later : LayerOrder::Earlier, rule);
        }
    }
    changed_ = unite(changed_, piece.area);
}

void PictureComposer::lost(int rank, const std::string& why) {
    incomplete_ = true;
    if (lost_.insert(rank).second)
        log::warning(log::Topic::Exchange, "a range of the picture is missing until its node rejoins: ", why);
}

} // namespace mural
