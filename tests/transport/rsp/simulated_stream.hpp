// One writer and many members of a group on a simulated network. Each member compares every byte with the written one.
#pragma once

#include <deque>
#include <memory>

#include "tests/transport/rsp/simulated_network.hpp"
#include "transport/rsp/wire/datagram_cipher.hpp"
#include "transport/rsp/protocol/receiver.hpp"
#include "transport/rsp/protocol/sender.hpp"

namespace mural::rsp::test {

struct StreamPlan {
    uint64_t seed = 1;
    size_t members = 1;
    uint64_t bytes = 1 << 20;   // to write
    size_t flushEveryBytes = 0; // 0: only at the end; otherwise the mean of random intervals
    uint32_t first = 7;         // first sequence number
    StreamShape shape{1430, 1024};
    RateSettings rate{};
    uint32_t socketDatagrams = 512;
    bool parity = true;
    Seal seal = Seal::None;
    LinkFaults toMembers{};
    LinkFaults toWriter{};
};

struct SimulatedMember {
    std::unique_ptr<Receiver> receiver;
    std::unique_ptr<DatagramSealer> sealer;
    std::unique_ptr<DatagramOpener> opener;
    uint64_t readBytes = 0; // position in the stream
    uint64_t wrongBytes = 0;
    double readBytesPerS = 0; // 0: immediately
    int64_t readNs = 0;
    int64_t lastProgressNs = 0;
    int64_t longestStallNs = 0;
    bool gone = false;
};

class SimulatedStream {
public:
    explicit SimulatedStream(const StreamPlan& plan);

    // Runs until everything is written and read by all remaining members, or until the time is over.
    bool run(int64_t forNs);
    // Continues until the time is over or `until` holds.
    bool run(int64_t forNs, const std::function<bool()>& until);
    [[nodiscard]] bool allRead() const;

    // Ends the member's process; removeMember tells the writer.
    void kill(size_t member) { members_[member].gone = true; }
    void remove(size_t member) { sender_.removeMember(static_cast<MemberId>(member + 1)); }
    size_t join();

    SimulatedNetwork& network() { return network_; }
    Sender& sender() { return sender_; }
    SimulatedMember& member(size_t i) { return members_[i]; }
    [[nodiscard]] size_t memberCount() const { return members_.size(); }
    [[nodiscard]] uint64_t wrongBytes() const;
    [[nodiscard]] uint64_t refusedDatagrams() const;
    [[nodiscard]] uint64_t writtenBytes() const { return written_; }
    static constexpr size_t host(size_t member) { return member + 1; }

private:
    class Wire;
    std::optional<StreamDatagram> landed(std::span<const std::byte> datagram, Receiver& receiver);
    void connect(size_t member);
    void runSender();
    void runMember(size_t member);
    void write();
    void read(SimulatedMember& m);

    StreamPlan plan_;
    SimulatedNetwork network_;
    SessionKeys keys_;
    DatagramSealer sealer_;
    DatagramOpener opener_;
    Sender sender_;
    std::deque<SimulatedMember> members_;
    uint64_t written_ = 0;
    uint64_t flushAt_ = 0;
    bool ended_ = false;
};

} // namespace mural::rsp::test
