// The protocol of one client of the control interface: received bytes become requests, and requests become replies and
// messages (docs/reference/control.md). Pure: no sockets, no clock. Used by one thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/head/control/control_operations.hpp"
#include "nodes/head/control/control_topic.hpp"

namespace mural {

inline constexpr int kControlVersion = 1;
inline constexpr size_t kMaxControlRequestBytes = size_t{64} << 10;
// Limit of the unsent data of a client. A client at the limit receives no further replies until it reads. A client at
// half of the limit receives no messages of its subscriptions.
inline constexpr size_t kMaxControlUnsentBytes = size_t{1} << 20;
inline constexpr size_t kMaxControlWaitingEntries = 256; // of a subscription, between two messages
inline constexpr int64_t kMinControlIntervalMs = 20;
inline constexpr int64_t kMaxControlIntervalMs = 3'600'000;

class ControlProtocol {
public:
    // operations: must outlive this object. hello: further members of the first line, such as the session's name.
    ControlProtocol(const ControlOperations& operations, const nlohmann::json& hello);
    ControlProtocol(const ControlProtocol&) = delete;
    ControlProtocol& operator=(const ControlProtocol&) = delete;

    // True if receive() may be called now. False while too many requests or replies wait.
    [[nodiscard]] bool acceptsBytes() const;
    void receive(std::string_view bytes);

    // True if perform() has work: a complete request waits, and its reply has room.
    [[nodiscard]] bool hasRequest() const;
    // Performs at most `most` requests, in order.
    void perform(size_t most, int64_t nowNs);

    [[nodiscard]] bool subscribes(ControlTopic topic) const { return at(topic).intervalNs > 0; }
    // Adds an entry (JSON) to the next message of the topic. Without a subscription it has no effect.
    void offer(ControlTopic topic, const std::string& entry);
    // Counts entries of the topic that were lost on their way to this object.
    void countDropped(ControlTopic topic, uint64_t entries);
    // Writes the messages that are due.
    void sendMessages(int64_t nowNs);
    // Returns the time of the next message; INT64_MAX: none.
    [[nodiscard]] int64_t nextMessageNs() const;

    [[nodiscard]] std::string_view unsent() const { return std::string_view(unsent_).substr(sentBytes_); }
    // Removes the first bytes of unsent().
    void sent(size_t bytes);
    // True after an error that ends the connection: it closes after unsent() has been sent.
    [[nodiscard]] bool isOver() const { return isOver_; }

private:
    struct Subscription {
        int64_t intervalNs = 0; // 0: none
        int64_t nextNs = 0;
        std::vector<std::string> entries; // waiting
        uint64_t dropped = 0;             // since the last message
    };

    [[nodiscard]] const Subscription& at(ControlTopic topic) const { return subscriptions_[indexOf(topic)]; }
    Subscription& at(ControlTopic topic) { return subscriptions_[indexOf(topic)]; }
    void addOwnOperations();
    Result<nlohmann::json> help() const;
    Result<nlohmann::json> subscribe(const nlohmann::json& arguments);
    Result<nlohmann::json> unsubscribe(const nlohmann::json& arguments);
    void performLine(std::string_view line, int64_t nowNs);
    ControlError performOperation(const std::string& name, const nlohmann::json& arguments, nlohmann::json& result);
    void refuseLongRequest();
    [[nodiscard]] bool hasMessage(ControlTopic topic) const;
    void sendMessage(ControlTopic topic);
    void write(const nlohmann::json& line);

    const ControlOperations& operations_;
    ControlOperations own_; // operations on this object
    std::array<Subscription, kControlTopics> subscriptions_;
    std::string received_; // no complete line before its performedBytes_
    size_t performedBytes_ = 0;
    std::string unsent_;
    size_t sentBytes_ = 0;
    int64_t nowNs_ = 0; // of perform(), for the handlers
    bool isOver_ = false;
};

} // namespace mural
