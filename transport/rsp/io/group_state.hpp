// Implementation of Group: core, sockets, control connections and thread.
#pragma once

#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/base/quick_clock.hpp"
#include "transport/rsp/io/socket_poller.hpp"
#include "transport/rsp/io/send_batcher.hpp"
#include "transport/rsp/io/control_link.hpp"
#include "transport/rsp/io/group_diagnostics.hpp"
#include "transport/rsp/group.hpp"
#include "transport/rsp/protocol/receive_moderation.hpp"
#include "transport/rsp/io/handover_timer.hpp"

namespace mural::rsp {

constexpr int64_t kSliceNs = 100 * kNsPerMs; // longest uninterrupted sleep of a wait

struct Group::State : GroupOutput {
    explicit State(const GroupOptions& options);
    ~State() override;

    Result<void> openHost();
    Result<void> openMember(Deadline deadline);
    void stop();

    // The following methods require the mutex.
    void pump(int64_t nowNs = quickNowNs()); // executes due work: sends, and wakes waiting threads
    [[nodiscard]] GroupReport report() const;

    // Implementation of GroupOutput.
    void control(MemberId to, const ControlMessage& message) override;
    std::span<std::byte> datagram(MemberId to, size_t bytes) override;
    bool behind() override;
    void welcomed(const Welcome& w) override;
    void memberCame(MemberId id, const MemberInfo& info) override;
    void memberGone(MemberId id, GoneReason reason) override;
    void memberRerouted(MemberId id, bool multicast) override;
    void hangUp(MemberId id, const std::string& why) override;

    mutable std::mutex mutex;
    // Threads waiting for one condition. Separate conditions avoid needless wake-ups, each of which costs more than a
    // datagram.
    struct Waits {
        std::condition_variable wake;
        size_t sleeping = 0; // number of threads, without the leader
    };
    Waits room;                           // the writer
    Waits arrived;                        // threads in waitArrived()
    Waits data;                           // readers
    std::condition_variable changed;      // membership
    std::vector<MemberId> waitingForData; // awaited members, one entry per waiting thread
    // Sleeps until the condition may hold or a slice of time is over. Returns false after the deadline. The first
    // waiting thread becomes the leader: it polls sockets and timer while the group's thread sleeps.
    bool wait(std::unique_lock<std::mutex>& lock, Waits& what, Deadline deadline);
    Result<size_t> readable(std::unique_lock<std::mutex>& lock, MemberId from,
                            std::span<std::span<const std::byte>> pieces, Deadline deadline);

    std::unique_ptr<GroupCore> core;
    std::string failure;   // reason for the end of the group; empty: alive
    bool hostLeft = false; // the host ended the group in order: end of its stream, not a failure
    std::set<MemberId> accepted;
    std::vector<MemberEvent> unreadEvents; // unread membership events
    std::string controlAddress;

private:
    using Tcp = boost::asio::ip::tcp;

    Result<void> openSockets();
    Result<void> joinMulticast();
    Result<void> openCore(bool isHost);
    void startThread();
    void acceptLinks();
    void startLink(MemberId id, const std::shared_ptr<ControlLink>& link);
    void watch();
    void lead(const Waits& what);
    void endLead(int64_t nowNs);
    void letWatch();
    void watchLeaders();
    [[nodiscard]] bool ownIsInTransit() const; // this member's stream has unacknowledged data
    [[nodiscard]] int64_t takeOverNs() const;  // time without a leader before the group's thread takes over
    [[nodiscard]] int64_t restNs(const Waits* what, int64_t nowNs) const;
    void receive(std::span<const int> sockets, int64_t nowNs);
    void takeDatagrams(std::span<const int> sockets, int64_t nowNs);
    void armTimer(int64_t atNs);
    void publishTimer(int64_t atNs);
    void wakeWaiting();
    void wake(Waits& what);
    void wakeAll();
    void endAfterGoodbyes(Deadline deadline);
    void fail(const std::string& why);
    void updateLoop();
    void ignoreOwn();
    void note(const MemberEvent& event);
    [[nodiscard]] uint32_t dropped() const;
    void sendControl(MemberId to, const ControlMessage& message);

    GroupOptions options_;
    SocketAddress group_;
    NetworkInterface interface_;
    boost::asio::io_context context_;
    boost::asio::steady_timer goodbyeTimer_{context_};
    boost::asio::steady_timer restTimer_{context_}; // timer of the group's thread
    std::optional<Tcp::acceptor> acceptor_;
    std::optional<UdpSocket> own_;
    std::optional<UdpSocket> groupSocket_;
    std::optional<SocketPoller> arrivals_;
    std::optional<boost::asio::posix::stream_descriptor> watched_; // wakes the group's thread while there is no leader
    const Waits* leaderWaitsFor_ = nullptr;                        // null: no leader
    bool leaderSleeps_ = false;
    int64_t leaderUntilNs_ = 0; // end of the leader's sleep
    bool leaderCalled_ = false; // the leader's condition may hold
    bool isWatched_ = true;     // otherwise there is a leader, or takeOver_ is armed
    std::optional<HandoverTimer> takeOver_;
    std::optional<boost::asio::posix::stream_descriptor> takeOverRings_;
    ReceiveModeration moderation_{GroupSettings{}.socketDatagrams};
    int64_t polledNs_ = INT64_MIN / 2;         // last poll of the sockets
    int64_t droppedQueriedNs_ = INT64_MIN / 2; // last query of the sockets' drop counters
    unsigned readsWithoutPoll_ = 0;            // reads since the last poll
    std::optional<SendBatcher> outbox_;
    std::optional<DatagramOpener> opener_;
    std::map<MemberId, std::shared_ptr<ControlLink>> links_;
    std::map<MemberId, MemberInfo> known_;             // including members whose departure is not reported yet
    std::set<std::shared_ptr<ControlLink>> strangers_; // not authenticated yet
    size_t windowBytes_ = 0;                           // of one stream of this group
    std::string hostAddress_;
    std::set<std::string> ownAddresses_; // addresses of this machine
    bool loop_ = true;                   // multicast loopback is on
    int64_t timerNs_ = INT64_MAX;        // time of the next due work
    int64_t publishedNs_ = INT64_MAX;    // time set in arrivals_
    GroupDiagnostics diagnostics_;
    std::thread thread_;
};

} // namespace mural::rsp
