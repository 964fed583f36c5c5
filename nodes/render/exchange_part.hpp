// A node's end of the picture exchange in sort-last rendering: connections to the nodes that draw the other ranges of
// the same picture, and the composition of their parts. Used by the replay thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "nodes/exchange/picture_composer.hpp"
#include "nodes/exchange/picture_exchange.hpp"
#include "nodes/session/session_config.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

class ExchangePart {
public:
    explicit ExchangePart(const NodeSetup& setup) : setup_(setup) {}

    // Listens for other nodes. Returns the port. Errors: invalid setup; no port.
    Result<uint16_t> open();

    // Returns the address at which a node listens; empty: the head has sent none.
    using AddressOf = std::function<std::optional<HostPort>(int node)>;
    // Connects to the nodes whose connections this node opens. Logs each node that it cannot reach; their parts are
    // missing. Errors: an address is missing.
    Result<void> connect(const AddressOf& addressOf);

    // Returns the rank of a node in the composition; empty: it draws another picture.
    [[nodiscard]] std::optional<int> rankOf(int node) const;

    // Requires open().
    [[nodiscard]] PictureComposer& composer() { return *composer_; }
    [[nodiscard]] uint64_t bytesSent() const { return exchange_->bytesSent(); }

private:
    [[nodiscard]] bool connectsTo(int rank) const;

    const NodeSetup setup_;
    std::unique_ptr<PictureExchange> exchange_;
    std::unique_ptr<PictureComposer> composer_; // uses exchange_
};

} // namespace mural
