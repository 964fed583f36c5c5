// Puts a picture together of what the nodes of several ranges have drawn, by a schedule that all of them know.
//
// A node that is lost takes along what others have sent it to be folded, in that picture. So where the strategy is not serial, the
// collector tells all after each picture how the next is put together: as before, or, once anything was missing, serially; then
// only what the lost node draws is missing. Parts say whether anything is missing in them.
//
// When a node is back, all begin anew in the same picture: who takes part is what the head has told all of them, and with nobody
// missing they go by the strategy of the start.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>

#include "compositor/strategies/schedule.hpp"
#include "nodes/exchange/part_message.hpp"
#include "nodes/exchange/part_routes.hpp"

namespace mural {

struct ComposerConfig {
    compositor::Strategy strategy = compositor::Strategy::Serial;
    int rank = 0, ranks = 1;
    int64_t partMs = 20'000; // how long another's part is waited for; as long as the head waits for a silent node
    int64_t wordMs = 60'000; // how long for the collector's word; it may have to wait for lost nodes first
    int64_t stageMs = 5'000; // and for each wait that the other may have before it sends: a lost node must not make others seem lost
    std::string plant;       // MURAL_PLANT: a fault on purpose, for tests of the tests
    std::string codec = kQuickestCodec; // as of PlaneEncoder
};

class PictureComposer {
public:
    using Log = std::function<void(const std::string&)>;
    PictureComposer(ComposerConfig config, PartRoutes& routes, Log log);

    // Each node calls this with what it has drawn. Afterwards the collector's part is the whole picture; the others' hold anything.
    // Returns the area of the part that may have changed. What nodes have drawn that are lost is missing: said once for each.
    PixelViewport compose(PicturePart& part, const FoldRule& rule);
    // From the next picture on that rank takes part again, in its `life`th life, and of the others all but those of `absent`. All that take
    // part, and it itself, call this between the same pictures.
    void returned(int rank, uint32_t life, const std::set<int>& absent);

private:
    void agree();
    void tellNext();
    void serially();
    void send(const PicturePart& part, const compositor::Step& step, const FoldRule& rule);
    void take(PicturePart& part, const compositor::Step& step, const FoldRule& rule, int64_t beganNs);
    void put(PicturePart& part, const ArrivedPiece& piece, compositor::Step::Kind kind, const FoldRule& rule);
    void lost(int rank, const std::string& why);

    const ComposerConfig config_;
    compositor::Strategy strategy_; // serial while nodes are lost
    PartRoutes& routes_;
    const Log log_;
    int32_t rows_ = -1;
    std::vector<compositor::Step> steps_;   // of this rank, for so many rows
    std::map<int, PlaneEncoder> encoders_;  // of each link
    PlaneDecoder decoder_;
    PixelViewport changed_;
    std::set<int> lost_;
    bool incomplete_ = false; // something is missing, here or in what has come
    bool agreed_ = true;      // the first picture needs no word
};

} // namespace mural
