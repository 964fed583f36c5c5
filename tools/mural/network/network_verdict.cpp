#include "tools/mural/network/network_verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/mural/network/probe_sockets.hpp"

namespace mural::cli {

namespace {

constexpr double kBadLoss = 0.01;
constexpr double kSomeLoss = 0.001;
constexpr double kSlowLinkBytesPerS = 125e6; // 1 Gbit/s

std::string percent(double share) { return fmt::format("{:.2g} %", share * 100); }

// Returns "eth0 at 1000 Mbit/s, packets of 1500 bytes".
Check card(const std::string& name, const MachineFacts& f) {
    std::string found = fmt::format("{}, MTU {} bytes", f.interface, f.mtuBytes);
    if (f.linkBytesPerS > 0) found += fmt::format(", {:.0f} Mbit/s", f.linkBytesPerS * 8e-6);
    if (!f.multicast && !f.loopback)
        return {Health::Bad, name, found + ", without multicast",
                fmt::format("`ip link set dev {} multicast on`, or give --interface", f.interface)};
    if (f.linkBytesPerS > 0 && f.linkBytesPerS < kSlowLinkBytesPerS)
        return {Health::Warn, name, found,
                fmt::format("slow for pictures and geometry: check the cable and the switch port (`ethtool {}`)",
                            f.interface)};
    return {Health::Ok, name, found, {}};
}

Check buffers(const std::string& name, const std::string& where, const MachineFacts& f) {
    const auto mib = [](size_t bytes) { return static_cast<double>(bytes) / (1 << 20); };
    const std::string found =
        fmt::format("{:.3g} of {:.0f} MiB receive buffer", mib(f.bufferBytes), mib(kWantedBufferBytes));
    if (f.bufferBytes >= kWantedBufferBytes) return {Health::Ok, name, found, {}};
    return {
        Health::Warn, name, found,
        fmt::format("`sysctl -w net.core.rmem_max={0} net.core.wmem_max={0}`{1}; make it permanent in /etc/sysctl.d",
                    kWantedBufferBytes, where)};
}

// Returns true if the sending interface is not the one towards the host, and no multicast arrives.
bool byWrongCard(const HereMeasured& here, const HostMeasured& h) {
    return !h.path(ProbePath::Group).to && !h.interfaceTowards.empty() && h.interfaceTowards != here.facts.interface;
}

// No multicast arrives, but unicast does.
Check noMulticast(const HereMeasured& here, const HostMeasured& h, const std::string& name) {
    const PathMeasured& group = h.path(ProbePath::Group);
    if (!group.trouble.empty())
        return {Health::Bad, name, group.trouble,
                fmt::format("check for a firewall rule that blocks sending, and for a missing route: `nft list "
                            "ruleset`, `ip route add 224.0.0.0/4 dev {}`",
                            here.facts.interface)};
    if (h.path(ProbePath::LinkLocal).to) {
        std::string querier = "enable the switch's IGMP querier, or disable its IGMP snooping";
        const auto& bridges = h.facts.silentBridges.empty() ? here.facts.silentBridges : h.facts.silentBridges;
        if (!bridges.empty())
            querier =
                fmt::format("`ip link set dev {} type bridge mcast_querier 1`, or enable the switch's IGMP querier",
                            bridges.front());
        return {Health::Bad, name,
                fmt::format("link-local multicast arrives, {} does not: the switch snoops IGMP without a querier, or a "
                            "firewall blocks the group",
                            here.group),
                querier + fmt::format("; allow incoming UDP to {} (`nft list ruleset`)", here.group)};
    }
    std::string advice = fmt::format("allow UDP to {} in the firewalls of both machines; many cloud networks and VPNs "
                                     "have no multicast, and nodes then receive the stream over TCP",
                                     here.group);
    if (h.facts.strictReturnPath)
        advice += fmt::format("; or replies use another interface: `sysctl -w net.ipv4.conf.all.rp_filter=2 "
                              "net.ipv4.conf.{}.rp_filter=2` on the host",
                              h.facts.interface);
    return {Health::Bad, name, "no multicast arrives, but unicast datagrams do", advice};
}

Check multicast(const HereMeasured& here, const HostMeasured& h, const std::string& name) {
    const PathMeasured& group = h.path(ProbePath::Group);
    if (!group.to) return noMulticast(here, h, name);
    if (!group.toLater)
        return {Health::Bad, name, "multicast arrived at first, then stopped: the switch snoops IGMP without a querier",
                "enable the switch's IGMP querier, or disable its IGMP snooping"};
    if (!group.from)
        return {Health::Warn, name, "multicast arrives at the host, but multicast from the host does not arrive here",
                fmt::format("allow UDP to {} in the firewalls of both machines; enable the switch's IGMP querier",
                            here.group)};
    if (h.hasStream && h.streamFailure.empty() && !h.multicast)
        return {Health::Bad, name, "single datagrams arrive, but the group's probes did not arrive in time",
                "see loss and datagram size, and repeat the test"};
    return {Health::Ok, name, "arrives in both directions", {}};
}

Check datagramSize(const HereMeasured& here, const HostMeasured& h, const std::string& name) {
    const PathMeasured& path = h.path(ProbePath::Group).to ? h.path(ProbePath::Group) : h.path(ProbePath::Single);
    const std::string found = fmt::format("datagrams up to {} bytes arrive", path.largestBytes);
    if (path.largestBytes >= here.cardBytes) return {Health::Ok, name, found, {}};
    const size_t packet = path.largestBytes + here.headerBytes;
    if (h.facts.mtuBytes < here.facts.mtuBytes && h.facts.mtuBytes <= packet)
        return {Health::Bad, name,
                fmt::format("{}; the MTU of {} there is {}, of {} here {}", found, h.facts.interface, h.facts.mtuBytes,
                            here.facts.interface, here.facts.mtuBytes),
                fmt::format("`ip link set dev {} mtu {}` there, or `ip link set dev {} mtu {}` here", h.facts.interface,
                            here.facts.mtuBytes, here.facts.interface, h.facts.mtuBytes)};
    return {Health::Bad, name,
            fmt::format("{}; both cards support {}, something between them does not", found, here.cardBytes),
            fmt::format("allow packets of {} bytes in the switches, or `ip link set dev {} mtu {}` here",
                        here.facts.mtuBytes, here.facts.interface, packet)};
}

Check stream(const HostMeasured& h, const std::string& name) {
    if (!h.streamFailure.empty())
        return {Health::Bad, name, h.streamFailure, "fix the lines above first; `mural netperf` shows more"};
    const std::string found = fmt::format("{:.0f} Mbit/s, loss {}, {}", h.bytesPerS * 8e-6, percent(h.lostShare),
                                          h.multicast ? "by multicast" : "by its TCP connection");
    if (h.droppedShare >= kSomeLoss)
        return {Health::Warn, name, fmt::format("{}, and {} dropped by its socket", found, percent(h.droppedShare)),
                "it reads too slowly: enlarge the socket buffers (see buffers), or reduce the load of its processors"};
    if (h.lostShare < kSomeLoss) return {Health::Ok, name, found, {}};
    if (h.queueDropped > 0)
        return {Health::Warn, name, fmt::format("{}, {} packets dropped by its kernel's queue", found, h.queueDropped),
                "`sysctl -w net.core.netdev_max_backlog=10000` there, or a lower --rate"};
    return {h.lostShare >= kBadLoss ? Health::Bad : Health::Warn, name, found,
            fmt::format("losses cost speed, not pictures: check `ethtool -S {}` there for errors of cable and card; on "
                        "a congested port, use a lower --rate",
                        h.facts.interface)};
}

} // namespace

std::vector<Check> judgeHere(const HereMeasured& here) {
    std::vector<Check> checks{card("card", here.facts), buffers("buffers", "", here.facts)};
    for (const std::string& bridge : here.facts.silentBridges) {
        checks.push_back({Health::Warn, "bridge " + bridge,
                          "snoops IGMP without a querier: group memberships expire after minutes if no router queries",
                          fmt::format("`ip link set dev {} type bridge mcast_querier 1`", bridge)});
    }
    return checks;
}

std::vector<Check> judgeHost(const HereMeasured& here, const HostMeasured& h) {
    const auto about = [&](const char* what) { return h.host + ": " + what; };
    if (!h.failure.empty())
        return {
            {Health::Bad, about("start"), h.failure,
             "check that its launch command runs `mural version` there without a password (--launch, --remote-mural)"}};
    std::vector<Check> checks;
    if (h.version != here.version)
        checks.push_back({Health::Bad, about("version"), fmt::format("{} there, {} here", h.version, here.version),
                          "install the same build on all machines"});
    if (h.reached.empty()) {
        checks.push_back({Health::Bad, about("connection"),
                          "the host cannot connect to this machine: " +
                              (h.unreachedWhy.empty() ? "no address to try" : h.unreachedWhy),
                          "allow TCP from the host to any port of this machine, or fix the route"});
        return checks;
    }
    checks.push_back({Health::Ok, about("connection"), fmt::format("{} connects to {}", h.own, h.reached), {}});
    checks.push_back(card(about("card"), h.facts));
    checks.push_back(buffers(about("buffers"), " there", h.facts));
    const PathMeasured& single = h.path(ProbePath::Single);
    if (byWrongCard(here, h)) {
        checks.push_back({Health::Bad, about("interface"),
                          fmt::format("{} is used here, but {} is reached through {}", here.facts.interface, h.host,
                                      h.interfaceTowards),
                          "add --interface " + h.interfaceTowards});
        return checks;
    }
    if (!single.to || !single.from) {
        const std::string found = !single.trouble.empty() ? single.trouble
                                                          : fmt::format("no UDP arrives {}", !single.to && !single.from
                                                                                                 ? "in either direction"
                                                                                             : single.to ? "here"
                                                                                                         : "there");
        checks.push_back(
            {Health::Bad, about("datagrams"), found,
             fmt::format("a firewall: allow UDP between {} and {}, all ports, both directions (`nft list ruleset`)",
                         h.own, h.reached)});
    }
    if (single.to || h.path(ProbePath::Group).to || h.path(ProbePath::LinkLocal).to) {
        checks.push_back(multicast(here, h, about("multicast")));
        checks.push_back(datagramSize(here, h, about("datagram size")));
    }
    if (h.hasStream) checks.push_back(stream(h, about("stream")));
    return checks;
}

} // namespace mural::cli
