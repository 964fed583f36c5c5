#include "nodes/render/exchange_part.hpp"

#include <cstdlib>
#include <utility>

#include "common/log/log.hpp"
#include "compositor/strategies/strategy.hpp"
#include "nodes/session/session_secret.hpp"

namespace mural {

namespace {

constexpr int64_t kConnectNodesMs = 10'000;

} // namespace

Result<uint16_t> ExchangePart::open() {
    const auto secret = sessionSecretFromHex(setup_.exchangeSecret);
    if (!secret) return Error{"the head sent an invalid secret for the picture exchange: " + secret.error().message};
    const auto strategy = compositor::strategyNamed(setup_.composition);
    if (!strategy)
        return Error{"the head sent the unknown composition \"" + setup_.composition +
                     "\"; install the same version of mural on both machines"};
    ComposerConfig config;
    config.strategy = *strategy;
    config.rank = setup_.pass.range;
    config.ranks = setup_.pass.ranges;
    config.codec = setup_.partCodec;
    if (const char* plant = std::getenv("MURAL_PLANT")) config.plant = plant;
    exchange_ =
        std::make_unique<PictureExchange>(PictureExchange::Name{config.rank, setup_.incarnation}, secret.value());
    composer_ = std::make_unique<PictureComposer>(config, *exchange_);
    // Every node listens, even one without initial peers: a restarted node connects to those present.
    if (auto listening = exchange_->listen(setup_.exchangeHere); !listening)
        return Error{"cannot listen for pictures of other nodes: " + listening.error().message};
    return exchange_->port();
}

// Returns whether this node opens the connection to the node of `rank`. Nodes connect to all lower ranks and accept
// connections of higher ones. A restarted node connects to all. With the serial strategy, nodes send to the collector
// only.
bool ExchangePart::connectsTo(int rank) const {
    const int own = setup_.pass.range;
    const bool toCollectorOnly = setup_.composition == compositor::nameOf(compositor::Strategy::Serial);
    return rank != own && (setup_.isResyncing || rank < own) && (!toCollectorOnly || rank == 0 || own == 0);
}

Result<void> ExchangePart::connect(const AddressOf& addressOf) {
    for (int rank = 0; rank < setup_.pass.ranges; ++rank) {
        if (!connectsTo(rank)) continue;
        const auto where = addressOf(setup_.collector + rank);
        if (!where && setup_.isResyncing) continue; // that node is lost or not ready
        if (!where)
            return Error{"the head sent no addresses for the picture exchange; install the same version of mural on "
                         "all machines"};
        const auto connected = exchange_->connectTo(rank, where->host, where->port, Deadline::inMs(kConnectNodesMs));
        if (!connected)
            log::warning(log::Topic::Exchange, "cannot connect to the node with range ", rank + 1, " at ",
                         endpointText(where->host, where->port), ": ", connected.error().message,
                         "; their parts of the picture are missing");
    }
    return {};
}

std::optional<int> ExchangePart::rankOf(int node) const {
    const int rank = node - setup_.collector;
    return rank >= 0 && rank < setup_.pass.ranges ? std::optional(rank) : std::nullopt;
}

} // namespace mural
