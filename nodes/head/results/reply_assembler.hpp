// Assembles the replies of the nodes to a program's request. All nodes receive the same stream, so every node answers
// every request. The first reply to a request therefore announces it here.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"
#include "common/base/result.hpp"
#include "nodes/head/results/byte_buffer.hpp"
#include "nodes/head/capture/capture_client.hpp"
#include "nodes/head/results/reply_senders.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

// Thread-safe. `deliver` is called without locks, once per request.
class ReplyAssembler {
public:
    using Deliver = std::function<void(uint32_t client, Reply reply)>;

    ReplyAssembler(int nodes, Deliver deliver);

    Result<void> answer(int node, const wire::ReplyPartHeader& header, ByteBuffer bytes);
    // Completes pending requests from the replies that have arrived.
    void nodeLost(int node);

    // Adds nodes that are no members yet.
    void addNodes(size_t count);
    // Adds a returned node. It answers requests from this view on.
    void nodeJoins(int node, uint32_t view);
    void nodeInView(int node, uint32_t view);

    [[nodiscard]] size_t openRequests() const;
    // Nodes that have not answered the client's oldest pending request.
    [[nodiscard]] std::vector<int> missing(uint32_t client) const;

private:
    using Key = std::pair<uint32_t, uint32_t>; // client, request

    struct Part {
        int node = 0;
        PixelViewport rectangle;
        ByteBuffer bytes;
    };
    struct Request {
        uint32_t kind = 0;
        uint32_t groupBytes = 0;
        std::vector<Part> parts;
        std::vector<bool> awaited; // per node at that time; false after it is lost
        std::vector<bool> last;    // per node: its reply is complete
        int firstNode = -1;        // the node whose reply counts (ReplyKind::Bytes)
        bool delivered = false;    // later replies are discarded
    };

    Result<void> add(int node, const wire::ReplyPartHeader& header, ByteBuffer bytes, Request& request);
    [[nodiscard]] bool allAnswered(const Request& request) const;
    [[nodiscard]] bool canDeliver(const Request& request) const;

    mutable std::mutex mutex_;
    const Deliver deliver_;
    ReplySenders views_;
    std::map<Key, Request> requests_;

    static Reply assemble(uint32_t requestId, const Request& request);
    static void assembleRectangle(const Request& request, Reply& reply);
    static void assembleBytes(const Request& request, Reply& reply);
    static void assembleSum(const Request& request, Reply& reply);
};

} // namespace mural
