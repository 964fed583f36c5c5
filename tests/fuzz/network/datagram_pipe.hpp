// A short queue for the datagrams of a fuzzed end. The input delivers, changes or drops them.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "transport/rsp/wire/datagram_sink.hpp"

namespace mural::fuzz {

class DatagramPipe : public rsp::DatagramSink {
public:
    std::span<std::byte> datagram(rsp::MemberId, size_t bytes) override {
        if (queue_.size() == kMax) queue_.pop_front();
        return queue_.emplace_back(bytes);
    }
    std::optional<std::vector<std::byte>> take() {
        if (queue_.empty()) return {};
        std::vector<std::byte> first = std::move(queue_.front());
        queue_.pop_front();
        return first;
    }

private:
    static constexpr size_t kMax = 512;
    std::deque<std::vector<std::byte>> queue_;
};

} // namespace mural::fuzz
