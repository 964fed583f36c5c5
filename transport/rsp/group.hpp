// A multicast group of this process: sockets, a thread and a lock around GroupCore. The host's clock, network and members
// are real here; all that is decided is decided there.
//
// Threads: any thread may write, read, wait and ask. One at a time writes; one at a time reads a member's stream. Who
// waits for bytes, room or arrival receives and keeps time meanwhile; when nobody does, a thread of the group's own.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/rsp/datagram_seal.hpp"
#include "transport/rsp/group_core.hpp"
#include "transport/secure_channel.hpp"

namespace mural::rsp {

constexpr size_t kMostDatagramBytes = 8972; // longer ones lose more at once than they save

struct GroupOptions {
    std::string group = "239.255.77.85:4277"; // multicast address and port; IPv6 in brackets
    std::string interface;                    // name or address; empty: the first that does multicast
    std::string control = ":0";               // host: where it listens; member: where the host listens
    std::string name = "member";              // by which the host knows the member's secret
    ChannelSecret secret{};
    bool multicast = true;
    // The host's:
    Seal seal = Seal::None;
    double bytesPerS = 0;       // at most; 0: 0.9 of what the card says, else no limit but the window
    size_t datagramBytes = 0;   // UDP payload; 0: what the card's packets hold
    uint32_t windowDatagrams = 4096;
    size_t socketBytes = size_t{8} << 20;
    StallPolicy stalled = StallPolicy::Eject;
    int64_t stalledMs = 2000;
    // A process that is stopped for a second is still one of us. After half of it, and of stalledMs, who lacks datagrams
    // gets them by its connection.
    int64_t silentMs = 1120;
    int64_t probeMs = 300; // how long a member may take to see multicast
    bool parity = true;
};

struct GroupReport {
    SenderCounters sender;
    RefusedDatagrams refused;
    uint64_t sendings = 0; // system calls
    uint32_t socketDropped = 0;
    std::string sendingBy;
    double bytesPerS = 0; // that the rate allows now
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

// What has become of a member, in the order in which it happened.
struct MemberEvent {
    enum class Kind { Came, Rerouted, Gone };
    Kind kind = Kind::Came;
    MemberId id = 0;
    MemberInfo info;                      // multicast: it is reached by it
    GoneReason reason = GoneReason::Left; // Gone
};

class Group {
public:
    static Result<std::unique_ptr<Group>> host(const GroupOptions& options);
    // Returns when this process is a member, or the deadline has passed.
    static Result<std::unique_ptr<Group>> join(const GroupOptions& options, Deadline deadline);
    ~Group(); // leaves

    // host:port at which members find the host.
    [[nodiscard]] std::string controlAddress() const;
    [[nodiscard]] MemberId self() const;
    // The ids of all others now.
    [[nodiscard]] std::vector<MemberId> members() const;
    [[nodiscard]] bool isMember(MemberId id) const;
    Result<void> waitForMembers(size_t count, Deadline deadline);
    // Those since the last call.
    std::vector<MemberEvent> takeEvents();
    // Host: nobody waits for this member any longer; its group is over.
    void remove(MemberId id, const std::string& why);
    // A member whose stream has begun and that was not yet returned.
    Result<MemberId> accept(Deadline deadline);

    // Leaves the group: all waits in it end, and so does what others hear. What came can still be read.
    void leave();
    // Copies as much of `bytes` as there is room for, at least one; waits for that. Errors: the deadline, the group's end.
    Result<size_t> writeSome(std::span<const std::byte> bytes, Deadline deadline);
    // Copies all of `bytes` into the stream, waiting for room. Errors: the deadline, the group's end.
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline);
    void flush();
    // All that was flushed is at all members.
    Result<void> waitArrived(Deadline deadline);

    // What is there of a member's stream, at least one byte; waits for it. 0: the member is gone, and all was read. A host
    // that is cut off is an error, for with it the group ends.
    Result<size_t> read(MemberId from, std::span<std::byte> into, Deadline deadline);
    // The same where they lie, for who need not have them elsewhere: a copy less. Returns how many of `pieces` it has set, each
    // of one datagram. They stay there until so many bytes are consumed, and hold up the writer when its window is full.
    Result<size_t> view(MemberId from, std::span<std::span<const std::byte>> pieces, Deadline deadline);
    void consume(MemberId from, size_t bytes);

    [[nodiscard]] GroupReport report() const;

private:
    struct State;
    explicit Group(std::shared_ptr<State> state);
    std::shared_ptr<State> state_;
};

} // namespace mural::rsp
