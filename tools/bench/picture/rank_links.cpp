#include "tools/bench/picture/rank_links.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <poll.h>
#include <span>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

namespace mural::bench {

namespace {

constexpr uint64_t kBarrierTag = ~uint64_t{0};
constexpr int kWaitMs = 60'000; // longer than any frame on a busy machine

struct Head {
    uint64_t tag, bytes;
};

// Ends the rank; the parent reports it.
[[noreturn]] void fail(const char* what) {
    std::fprintf(stderr, "compositing_bench: a rank %s: %s\n", what, std::strerror(errno));
    std::_Exit(1);
}

void waitReadable(int socket) {
    pollfd wait{socket, POLLIN, 0};
    int ready = 0;
    do ready = poll(&wait, 1, kWaitMs);
    while (ready < 0 && errno == EINTR);
    if (ready == 0) errno = ETIMEDOUT;
    if (ready <= 0) fail("waited for another");
}

} // namespace

Result<RankSockets> RankSockets::make(int ranks) {
    RankSockets all;
    all.ends_.assign(static_cast<size_t>(ranks), std::vector<int>(static_cast<size_t>(ranks), -1));
    for (int a = 0; a < ranks; ++a)
        for (int b = a + 1; b < ranks; ++b) {
            std::array<int, 2> pair{};
            if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) != 0) {
                const Error error{std::string("no sockets between ranks: ") + std::strerror(errno) +
                                  "; raise ulimit -n"};
                all.closeAll();
                return error;
            }
            all.ends_[static_cast<size_t>(a)][static_cast<size_t>(b)] = pair[0];
            all.ends_[static_cast<size_t>(b)][static_cast<size_t>(a)] = pair[1];
        }
    return all;
}

void RankSockets::closeAll() { closeOthers(-1); }
void RankSockets::closeOthers(int own) {
    for (size_t a = 0; a < ends_.size(); ++a)
        for (int& end : ends_[a]) {
            if (static_cast<int>(a) == own || end < 0) continue;
            close(end);
            end = -1;
        }
}

RankLinks::RankLinks(const RankSockets& sockets, int own) : own_(own) {
    for (int r = 0; r < sockets.ranks(); ++r) {
        peers_.push_back(std::make_unique<Peer>());
        Peer& peer = *peers_.back();
        peer.socket = sockets.end(own, r);
        if (peer.socket >= 0) peer.sender = std::thread([this, &peer] { send(peer); });
    }
}

RankLinks::~RankLinks() {
    for (auto& peer : peers_) {
        {
            const std::lock_guard lock(peer->mutex);
            peer->stop = true;
            peer->changed.notify_all();
        }
        if (peer->sender.joinable()) peer->sender.join();
    }
}

void RankLinks::send(Peer& peer) {
    std::unique_lock lock(peer.mutex);
    for (;;) {
        peer.changed.wait(lock, [&] { return peer.stop || !peer.outgoing.empty(); });
        if (peer.outgoing.empty()) return;
        const Posted next = peer.outgoing.front();
        lock.unlock();
        Head head{next.tag, next.bytes.size()};
        std::array<iovec, 2> parts{
            {{&head, sizeof head}, {const_cast<std::byte*>(next.bytes.data()), next.bytes.size()}}};
        const int64_t beganNs = monotonicNowNs();
        while (parts[0].iov_len + parts[1].iov_len > 0) {
            msghdr message{};
            message.msg_iov = parts.data();
            message.msg_iovlen = parts.size();
            ssize_t put = sendmsg(peer.socket, &message, MSG_NOSIGNAL);
            if (put < 0 && errno == EINTR) continue;
            if (put < 0) fail("sent to another");
            for (iovec& part : parts) {
                const size_t of = std::min(part.iov_len, static_cast<size_t>(put));
                part.iov_base = static_cast<std::byte*>(part.iov_base) + of;
                part.iov_len -= of;
                put -= static_cast<ssize_t>(of);
            }
        }
        const int64_t tookNs = monotonicNowNs() - beganNs;
        lock.lock();
        peer.outgoing.pop_front();
        ++peer.sent;
        peer.transferBytes += next.bytes.size();
        peer.transferNs += tookNs;
        peer.changed.notify_all();
    }
}

void RankLinks::readAll(Peer& peer, std::span<std::byte> into) {
    while (!into.empty()) {
        const ssize_t got = recv(peer.socket, into.data(), into.size(), MSG_DONTWAIT);
        if (got > 0)
            into = into.subspan(static_cast<size_t>(got));
        else if (got == 0) {
            errno = ECONNRESET;
            fail("read from another");
        } else if (errno == EAGAIN)
            waitReadable(peer.socket);
        else if (errno != EINTR)
            fail("read from another");
    }
}

uint64_t RankLinks::post(int to, uint64_t tag, std::span<const std::byte> bytes) {
    Peer& peer = *peers_[static_cast<size_t>(to)];
    if (tag != kBarrierTag) bytesSent_ += bytes.size();
    const std::lock_guard lock(peer.mutex);
    peer.outgoing.push_back({tag, bytes});
    peer.changed.notify_all();
    return ++peer.posted;
}

void RankLinks::waitSent(int to, uint64_t number) {
    Peer& peer = *peers_[static_cast<size_t>(to)];
    std::unique_lock lock(peer.mutex);
    if (!peer.changed.wait_for(lock, std::chrono::milliseconds(kWaitMs), [&] { return peer.sent >= number; })) {
        errno = ETIMEDOUT;
        fail("sent to another");
    }
}

RankMessage RankLinks::take(int from, uint64_t tag) {
    Peer& peer = *peers_[static_cast<size_t>(from)];
    const auto found = std::ranges::find(peer.came, tag, &RankMessage::tag);
    if (found != peer.came.end()) {
        RankMessage message = std::move(*found);
        peer.came.erase(found);
        return message;
    }
    for (;;) {
        Head head{};
        readAll(peer, std::as_writable_bytes(std::span(&head, 1)));
        RankMessage message{head.tag, std::vector<std::byte>(head.bytes)};
        readAll(peer, message.bytes);
        if (head.tag == tag) return message;
        peer.came.push_back(std::move(message));
    }
}

size_t RankLinks::takeInto(int from, uint64_t tag, std::span<std::byte> into) {
    Peer& peer = *peers_[static_cast<size_t>(from)];
    if (std::ranges::find(peer.came, tag, &RankMessage::tag) == peer.came.end()) {
        Head head{};
        readAll(peer, std::as_writable_bytes(std::span(&head, 1)));
        if (head.tag == tag && head.bytes <= into.size()) {
            readAll(peer, into.first(head.bytes));
            return head.bytes;
        }
        peer.came.push_back({head.tag, std::vector<std::byte>(head.bytes)});
        readAll(peer, peer.came.back().bytes);
    }
    const RankMessage message = take(from, tag);
    const size_t count = std::min(message.bytes.size(), into.size());
    std::copy_n(message.bytes.begin(), count, into.begin());
    return count;
}

bool RankLinks::waiting(int from, uint64_t tag) {
    Peer& peer = *peers_[static_cast<size_t>(from)];
    if (std::ranges::find(peer.came, tag, &RankMessage::tag) != peer.came.end()) return true;
    Head head{};
    const ssize_t got = recv(peer.socket, &head, sizeof head, MSG_PEEK | MSG_DONTWAIT);
    if (got != static_cast<ssize_t>(sizeof head)) return false;
    if (head.tag == tag) return true;
    readAll(peer, std::as_writable_bytes(std::span(&head, 1))); // another tag: queue it
    peer.came.push_back({head.tag, std::vector<std::byte>(head.bytes)});
    readAll(peer, peer.came.back().bytes);
    return waiting(from, tag);
}

void RankLinks::waitForAny(const std::vector<int>& from) {
    std::vector<pollfd> waits;
    for (const int rank : from) waits.push_back({peers_[static_cast<size_t>(rank)]->socket, POLLIN, 0});
    if (poll(waits.data(), waits.size(), kWaitMs) == 0) {
        errno = ETIMEDOUT;
        fail("waited for others");
    }
}

void RankLinks::barrier() {
    const std::byte token{1};
    const std::span<const std::byte> bytes(&token, 1);
    std::vector<uint64_t> numbers(peers_.size(), 0);
    const auto notify = [&](int to) { numbers[static_cast<size_t>(to)] = post(to, kBarrierTag, bytes); };
    if (own_ != 0) {
        notify(0);
        (void)take(0, kBarrierTag);
    } else {
        for (int r = 1; r < ranks(); ++r) (void)take(r, kBarrierTag);
        for (int r = 1; r < ranks(); ++r) notify(r);
    }
    for (int r = 0; r < ranks(); ++r)
        if (numbers[static_cast<size_t>(r)] > 0) waitSent(r, numbers[static_cast<size_t>(r)]);
}

std::pair<uint64_t, int64_t> RankLinks::takeTransfer(int to) {
    Peer& peer = *peers_[static_cast<size_t>(to)];
    const std::lock_guard lock(peer.mutex);
    return {std::exchange(peer.transferBytes, 0), std::exchange(peer.transferNs, 0)};
}

} // namespace mural::bench
