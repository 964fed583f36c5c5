// A multicast group of this process: sockets, a thread and a lock around GroupCore, which makes all decisions.
//
// Thread safety: any thread may write, read, wait and query. At most one thread writes, and at most one reads each
// member's stream. A thread that waits for data, room or acknowledgement also polls sockets and timer. Otherwise the
// group's own thread does.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "transport/rsp/wire/datagram_cipher.hpp"
#include "transport/rsp/protocol/group_core.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural::rsp {

constexpr size_t kMaxDatagramBytes = 8972; // a longer datagram would lose more at once than it saves

struct GroupOptions {
    std::string group = "239.255.77.85:4277"; // multicast address and port; IPv6 in brackets
    std::string interface;                    // name or address; empty: the first interface with multicast
    std::string control = ":0";               // host: listening address; member: the host's address
    std::string name = "member";              // identifies the member's secret to the host
    ChannelSecret secret{};
    bool multicast = true;
    // Settings of the host:
    Seal seal = Seal::None;
    double bytesPerS = 0;     // maximum rate; 0: 0.9 of the interface's rate, unlimited if that is unknown
    size_t datagramBytes = 0; // UDP payload; 0: from the interface's MTU
    uint32_t windowDatagrams = 4096;
    size_t socketBytes = size_t{8} << 20;
    StallPolicy stalled = StallPolicy::Eject;
    int64_t stalledMs = 2000;
    // Eviction timeout; tolerates a process that is stopped for one second. After half of it, or of stalledMs, a member
    // with missing datagrams receives them over its control connection.
    int64_t silentMs = 1120;
    int64_t probeMs = 300; // timeout of the multicast probe
    bool parity = true;
};

struct GroupReport {
    SenderCounters sender;
    RefusedDatagrams refused;
    uint64_t sendings = 0; // send system calls
    uint32_t socketDropped = 0;
    std::string sendingBy;
    double bytesPerS = 0; // current rate limit
    struct Stream {
        MemberId from = 0;
        ReceiveCounters received;
        uint32_t lost = 0;
        uint64_t feedback = 0;
    };
    std::vector<Stream> streams;
    struct Member {
        MemberId id = 0;
        MemberInfo info;
        MemberState state;
        bool waitedFor = false;
    };
    std::vector<Member> members;
};

// Membership event, in order of occurrence.
struct MemberEvent {
    enum class Kind { Came, Rerouted, Gone };
    Kind kind = Kind::Came;
    MemberId id = 0;
    MemberInfo info;                      // multicast: reachable by multicast
    GoneReason reason = GoneReason::Left; // for Gone
};

class Group {
public:
    static Result<std::unique_ptr<Group>> host(const GroupOptions& options);
    // Joins, and returns when this process is a member. Error: the deadline.
    static Result<std::unique_ptr<Group>> join(const GroupOptions& options, Deadline deadline);
    ~Group(); // leaves the group

    // Returns host:port at which members find the host.
    [[nodiscard]] std::string controlAddress() const;
    [[nodiscard]] MemberId self() const;
    // Returns the ids of all other members.
    [[nodiscard]] std::vector<MemberId> members() const;
    [[nodiscard]] bool isMember(MemberId id) const;
    Result<void> waitForMembers(size_t count, Deadline deadline);
    // Returns the events since the last call.
    std::vector<MemberEvent> takeEvents();
    // Host: evicts a member. Its group ends.
    void remove(MemberId id, const std::string& why);
    // Returns a member whose stream has begun, each once.
    Result<MemberId> accept(Deadline deadline);

    // Leaves the group. All waits end with an error. Received data stays readable.
    void leave();
    // Copies as many of `bytes` as there is room for, at least one; waits for room. Errors: deadline, end of the group.
    Result<size_t> writeSome(std::span<const std::byte> bytes, Deadline deadline);
    // Copies all of `bytes` into the stream; waits for room. Errors: deadline, end of the group.
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline);
    void flush();
    // Blocks until all members have acknowledged all flushed data.
    Result<void> waitArrived(Deadline deadline);

    // Reads from a member's stream, at least one byte; waits for data. 0: the member has left and everything is read.
    // The loss of the host is an error, because the group ends.
    Result<size_t> read(MemberId from, std::span<std::byte> into, Deadline deadline);
    // Zero-copy variant of read(): sets up to pieces.size() spans, one per datagram, and returns their number. They
    // stay valid until consumed. Unconsumed data stalls the writer when its window is full.
    Result<size_t> view(MemberId from, std::span<std::span<const std::byte>> pieces, Deadline deadline);
    void consume(MemberId from, size_t bytes);

    [[nodiscard]] GroupReport report() const;

private:
    struct State;
    explicit Group(std::shared_ptr<State> state);
    std::shared_ptr<State> state_;
};

} // namespace mural::rsp
