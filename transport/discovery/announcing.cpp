#include "transport/discovery/announcing.hpp"

#include <algorithm>
#include <random>
#include <sys/eventfd.h>

#include "common/log/log.hpp"
#include "transport/discovery/beacon_sockets.hpp"
#include "transport/tcp/socket_wait.hpp"
#include "transport/system_error.hpp"

namespace mural {

namespace {
constexpr int64_t kRescanCardsNs = 5 * kNsPerS;
constexpr int64_t kMaxWaitNs = kNsPerS;

Deadline until(int64_t atNs) {
    return Deadline::inMs(
        std::clamp<int64_t>((atNs - monotonicNowNs() + kNsPerMs - 1) / kNsPerMs, 0, kMaxWaitNs / kNsPerMs));
}
} // namespace

Result<std::unique_ptr<Announcing>> Announcing::start(const Announcement& self, const DiscoveryOptions& options) {
    FileDescriptor stop(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
    if (!stop.valid()) return Error{"cannot create an eventfd for announcements: " + errnoText(errno)};
    return std::unique_ptr<Announcing>(new Announcing(self, options, std::move(stop)));
}

Announcing::Announcing(const Announcement& self, const DiscoveryOptions& options, FileDescriptor stop)
    : self_(self), options_(options), stop_(std::move(stop)) {
    self_.kind = AnnouncementKind::Here;
    if (options_.avahi) publisher_ = std::make_unique<AvahiPublisher>(self_);
    if (options_.beacon) thread_ = std::thread([this] { run(); });
}

Announcing::~Announcing() {
    (void)eventfd_write(stop_.get(), 1);
    if (thread_.joinable()) thread_.join();
}

std::string Announcing::beaconTrouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
}

// Reopens sockets when interfaces change: a machine may start before its network.
void Announcing::run() {
    Announcer announcer(self_, std::random_device{}());
    while (true) {
        const std::string cards = BeaconSockets::fingerprint();
        auto sockets = BeaconSockets::open(options_.interface);
        {
            const std::lock_guard lock(mutex_);
            trouble_ = sockets ? "" : sockets.error().message;
            log::debug(log::Topic::Discovery, sockets ? "announces this node by beacon" : trouble_);
        }
        int64_t pollNs = monotonicNowNs() + kRescanCardsNs;
        if (!sockets) {
            if (waitForSocket(stop_.get(), POLLIN, Deadline::inMs(kRescanCardsNs / kNsPerMs)) != 0) return;
            continue;
        }
        while (true) {
            const int64_t nextNs =
                announcer.tick(monotonicNowNs(), [&](std::span<const std::byte> bytes) { sockets->broadcast(bytes); });
            const auto onReceived = [&](const Announcement& a, const std::string&) {
                announcer.onAnnouncement(a, monotonicNowNs());
            };
            if (sockets->listen(until(nextNs), stop_.get(), onReceived)) {
                sockets->broadcast(announcer.farewell());
                return;
            }
            if (monotonicNowNs() < pollNs) continue;
            if (BeaconSockets::fingerprint() != cards) break;
            pollNs = monotonicNowNs() + kRescanCardsNs;
        }
    }
}

} // namespace mural
