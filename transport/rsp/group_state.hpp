// What is behind a Group: its core, sockets, control connections and thread.
#pragma once

#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/quick_clock.hpp"
#include "transport/rsp/arrivals.hpp"
#include "transport/rsp/batch_outbox.hpp"
#include "transport/rsp/control_link.hpp"
#include "transport/rsp/group.hpp"
#include "transport/rsp/receive_moderation.hpp"
#include "transport/rsp/take_over_timer.hpp"

namespace mural::rsp {

constexpr int64_t kSliceNs = 100 * kNsPerMs; // how long a wait lasts at most before it looks again

struct Group::State : GroupOutput {
    explicit State(const GroupOptions& options);
    ~State() override;

    Result<void> openHost();
    Result<void> openMember(Deadline deadline);
    void stop();

    // The following with the mutex held.
    void pump(int64_t nowNs = quickNowNs()); // what is due now: sends, and wakes who waits
    [[nodiscard]] GroupReport report() const;

    // GroupOutput
    void control(MemberId to, const ControlMessage& message) override;
    std::span<std::byte> datagram(MemberId to, size_t bytes) override;
    bool behind() override;
    void welcomed(const Welcome& w) override;
    void memberCame(MemberId id, const MemberInfo& info) override;
    void memberGone(MemberId id, GoneReason reason) override;
    void memberRerouted(MemberId id, bool multicast) override;
    void hangUp(MemberId id, const std::string& why) override;

    mutable std::mutex mutex;
    // Nobody is woken for what it does not wait for: a wake costs more than a datagram.
    struct Waits {
        std::condition_variable wake;
        size_t sleeping = 0; // threads; the leader is none of them
    };
    Waits room;    // for the writer
    Waits arrived; // for who waits until all have everything
    Waits data;    // for readers
    std::condition_variable changed; // members
    std::vector<MemberId> waitingForData; // of these members, one for each who waits: few
    // Sleeps until there may be news, or a slice of time is over; false: the deadline has passed before. The first one that
    // waits leads: it sees to the sockets and the timer, and the group's thread sleeps on.
    bool wait(std::unique_lock<std::mutex>& lock, Waits& what, Deadline deadline);
    Result<size_t> readable(std::unique_lock<std::mutex>& lock, MemberId from, std::span<std::span<const std::byte>> pieces, Deadline deadline);

    std::unique_ptr<GroupCore> core;
    std::string failure; // why the group is over; empty: it is not
    bool hostLeft = false; // the host ended the group in order: that is its stream's end, no failure of it
    std::set<MemberId> accepted;
    std::vector<MemberEvent> news; // of members, not yet asked for
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
    [[nodiscard]] bool ownIsOnItsWay() const; // not all members are known to have all of it
    [[nodiscard]] int64_t takeOverNs() const; // for which no leader may be there, until the group's thread takes over
    [[nodiscard]] int64_t restNs(const Waits* what, int64_t nowNs) const;
    void receive(std::span<const int> sockets, int64_t nowNs);
    void takeDatagrams(std::span<const int> sockets, int64_t nowNs);
    void armTimer(int64_t atNs);
    void tellTime(int64_t atNs);
    void wakeWaiting();
    void wake(Waits& what);
    void wakeAll();
    void endWhenSaid(Deadline deadline);
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
    boost::asio::steady_timer restTimer_{context_}; // of the group's thread
    std::optional<Tcp::acceptor> acceptor_;
    std::optional<UdpSocket> own_;
    std::optional<UdpSocket> groupSocket_;
    std::optional<Arrivals> arrivals_;
    std::optional<boost::asio::posix::stream_descriptor> watched_; // wakes the group's thread while nobody leads
    const Waits* leaderWaitsFor_ = nullptr;                        // nullptr: nobody leads
    bool leaderSleeps_ = false;
    int64_t leaderUntilNs_ = 0; // it sleeps so long at most
    bool leaderCalled_ = false; // there may be what it waits for
    bool isWatched_ = true;     // else somebody leads, or takeOver_ is set
    std::optional<TakeOverTimer> takeOver_;
    std::optional<boost::asio::posix::stream_descriptor> takeOverRings_;
    ReceiveModeration moderation_{GroupSettings{}.socketDatagrams};
    int64_t lookedNs_ = INT64_MIN / 2; // at the sockets
    int64_t askedDroppedNs_ = INT64_MIN / 2; // how many the sockets have dropped
    unsigned looksUnasked_ = 0; // which sockets have something
    std::optional<BatchOutbox> outbox_;
    std::optional<DatagramOpener> opener_;
    std::map<MemberId, std::shared_ptr<ControlLink>> links_;
    std::map<MemberId, MemberInfo> known_; // those of whom memberGone has not yet told
    std::set<std::shared_ptr<ControlLink>> strangers_; // have not shown that they know the secret
    size_t windowBytes_ = 0; // of a stream of this group
    std::string hostAddress_;
    std::set<std::string> ownAddresses_; // of this machine
    bool loop_ = true;                   // members on this machine are reached
    int64_t timerNs_ = INT64_MAX; // when something is due
    int64_t toldNs_ = INT64_MAX;  // the time that arrivals_ knows of
    std::thread thread_;
};

} // namespace mural::rsp
