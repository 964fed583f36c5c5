// Composites the picture parts of several ranges, by a schedule that all nodes know.
//
// A lost node may take contributions of other nodes with it. Except with the serial strategy, the collector therefore
// announces the strategy of the next picture after each picture. After a loss it announces the serial one, so that only
// the lost node's own range is missing. Each part states whether it is complete.
//
// After a return, all nodes restart at the same picture, with the members that the head has announced. With all nodes
// present they use the initial strategy.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "compositor/strategies/schedule.hpp"
#include "nodes/exchange/part_message.hpp"
#include "nodes/exchange/part_routes.hpp"

namespace mural {

struct ComposerConfig {
    compositor::Strategy strategy = compositor::Strategy::Serial;
    int rank = 0, ranks = 1;
    int64_t partMs = 20'000;            // limit for a part of another node; equals the head's limit for silent nodes
    int64_t decisionMs = 60'000;        // limit for the collector's decision, which may wait for lost nodes
    int64_t stageMs = 5'000;            // added per earlier stage, so that one lost node does not make others seem lost
    std::string plant;                  // MURAL_PLANT: fault injection for tests
    std::string codec = kQuickestCodec; // see PlaneEncoder
};

class PictureComposer {
public:
    PictureComposer(ComposerConfig config, PartRoutes& routes);

    // Called by each node with its part. Afterwards the collector's part is the whole picture; other nodes' parts are
    // undefined. Returns the area that may have changed. Reports each lost node once; its range is missing.
    // `order`: the ranks, the first drawn first; empty: in the order of their numbers. Equal on all nodes; another
    // order of another node is reported once, and makes the picture wrong.
    PixelViewport compose(PicturePart& part, const CompositeRule& rule, const std::vector<int>& order = {});
    // From the next picture on, this incarnation of the rank takes part, and so do all ranks except `absent`. All
    // participants must call this between the same two pictures.
    void returned(int rank, uint32_t incarnation, const std::set<int>& absent);

private:
    void agree();
    Result<std::vector<std::byte>> receive(int rank, size_t maxBytes, Deadline deadline);
    void sendNext();
    void serially();
    void send(const PicturePart& part, const compositor::Step& step, const CompositeRule& rule);
    void take(PicturePart& part, const compositor::Step& step, const CompositeRule& rule, int64_t beganNs);
    void put(PicturePart& part, const ArrivedPiece& piece, compositor::Step::Kind kind, const CompositeRule& rule);
    void lost(int rank, const std::string& why);
    void reportOrder(int rank);
    [[nodiscard]] std::string hintAboutOrder() const;

    const ComposerConfig config_;
    compositor::Strategy strategy_; // serial while nodes are lost
    PartRoutes& routes_;
    int32_t rows_ = -1;
    std::vector<int> order_;               // of steps_
    std::vector<compositor::Step> steps_;  // of this rank, for the current number of rows
    std::map<int, PlaneEncoder> encoders_; // per link
    PlaneDecoder decoder_;
    PixelViewport changed_;
    std::set<int> lost_;
    bool incomplete_ = false; // some contribution is missing
    bool hasReportedOrder_ = false;
    bool agreed_ = true; // the first picture needs no decision
};

} // namespace mural
