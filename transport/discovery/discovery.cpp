#include "transport/discovery/discovery.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <poll.h>

#include "common/log/log.hpp"
#include "transport/discovery/avahi_browser.hpp"
#include "transport/discovery/beacon_sockets.hpp"

namespace mural {

namespace {

// Searches are repeated at growing intervals, because datagrams may be lost.
constexpr int64_t kFirstPauseMs = 100;
constexpr int64_t kMaxPauseMs = 1'000;
constexpr int64_t kWaitSliceMs = 50;

// Shared with Avahi's thread, which may outlive the search.
struct Found {
    std::mutex mutex;
    NodeTable table;
};

int64_t sooner(Deadline deadline, int64_t ms) { return std::min(ms, deadline.leftNs(ms * kNsPerMs) / kNsPerMs + 1); }

} // namespace

Discovered discoverNodes(const DiscoveryOptions& options, Deadline deadline,
                         const std::function<bool(const std::vector<FoundNode>&)>& enough) {
    Discovered result;
    const auto found = std::make_shared<Found>();
    std::optional<AvahiBrowser> browser;
    if (options.avahi) {
        browser.emplace(
            [found](const Announcement& a, const std::string& address) {
                const std::lock_guard lock(found->mutex);
                found->table.foundByAvahi(a, address);
            },
            [found](const Uuid& uuid) {
                const std::lock_guard lock(found->mutex);
                found->table.lostByAvahi(uuid);
            });
    }
    std::optional<BeaconSockets> sockets;
    if (options.beacon) {
        auto opened = BeaconSockets::open(options.interface);
        if (opened)
            sockets.emplace(std::move(*opened));
        else
            result.beaconTrouble = opened.error().message;
    }
    Announcement search;
    search.kind = AnnouncementKind::Search;
    const auto question = encode(search);
    int64_t pauseMs = kFirstPauseMs;
    Deadline again = Deadline::inMs(0);
    do {
        if (sockets && again.passed()) {
            sockets->broadcast(question);
            again = Deadline::inMs(pauseMs);
            pauseMs = std::min(2 * pauseMs, kMaxPauseMs);
        }
        const Deadline slice = Deadline::inMs(sooner(deadline, kWaitSliceMs));
        if (sockets) {
            (void)sockets->listen(slice, -1, [&](const Announcement& a, const std::string& from) {
                const std::lock_guard lock(found->mutex);
                found->table.onBeacon(a, from, monotonicNowNs());
            });
        } else {
            poll(nullptr, 0, static_cast<int>(slice.leftNs() / kNsPerMs));
        }
        const std::lock_guard lock(found->mutex);
        found->table.expire(monotonicNowNs());
        result.nodes = found->table.nodes();
    } while (!deadline.passed() && !(enough && enough(result.nodes)));
    if (browser) result.avahiTrouble = browser->trouble();
    for (const FoundNode& node : result.nodes)
        log::debug(log::Topic::Discovery, "found ", node.name, ", port ", node.port);
    return result;
}

} // namespace mural
