#include "tools/mural/netperf.hpp"

#include <algorithm>
#include <memory>
#include <sys/resource.h>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/clock.hpp"
#include "nodes/launch/program_check.hpp"
#include "transport/rsp/group.hpp"
#include "transport/rsp/group_text.hpp"

namespace mural::cli {

namespace {

using nlohmann::json;
using rsp::Group;

constexpr size_t kPieceBytes = 256 * 1024;
constexpr size_t kWarmUp = 20; // messages that are not counted

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6; }

double cpuS() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double nowS() { return static_cast<double>(monotonicNowNs()) * 1e-9; }

struct Plan {
    rsp::GroupOptions options;
    uint64_t bytes = 0;
    uint64_t messageBytes = 0;
};

Result<Plan> planOf(const NetperfArguments& a) {
    Plan plan;
    rsp::GroupOptions& o = plan.options;
    o.group = a.group;
    o.interface = a.interface;
    o.control = a.control;
    o.multicast = !a.noMulticast;
    o.parity = !a.noParity;
    o.datagramBytes = a.datagramBytes;
    auto seal = rsp::parseSeal(a.seal);
    if (!seal) return seal.error();
    o.seal = *seal;
    auto rate = rsp::parseRate(a.rate);
    if (!rate) return rate.error();
    o.bytesPerS = *rate;
    auto bytes = rsp::parseSize(a.bytes);
    auto message = rsp::parseSize(a.message);
    auto window = rsp::parseSize(a.window);
    if (!bytes) return bytes.error();
    if (!message) return message.error();
    if (!window) return window.error();
    if (*window < 64 || *window > 65'536 || (*window & (*window - 1)) != 0) return Error{"a window has 64 to 65536 datagrams, a power of two"};
    o.windowDatagrams = static_cast<uint32_t>(*window);
    plan.bytes = *bytes;
    plan.messageBytes = *message;
    if (a.role == "local") {
        o.interface = a.interface.empty() ? "lo" : a.interface;
        o.control = "127.0.0.1:0";
        return plan;
    }
    if (a.secretFile.empty()) return Error{"--secret-file is needed: sender and receivers show each other that they know it"};
    auto secret = rsp::readSecret(a.secretFile);
    if (!secret) return secret.error();
    o.secret = *secret;
    return plan;
}

// What one end measured.
struct Measured {
    std::string role;
    uint64_t bytes = 0;
    double elapsedS = 0;
    double cpuS = 0;
    std::vector<double> latenciesUs; // sorted
    rsp::GroupReport report;

    [[nodiscard]] double mbit() const { return elapsedS > 0 ? static_cast<double>(bytes) * 8e-6 / elapsedS : 0; }
    [[nodiscard]] double cpuPerGB() const { return bytes > 0 ? cpuS / (static_cast<double>(bytes) * 1e-9) : 0; }
    [[nodiscard]] double latencyUs(double share) const {
        if (latenciesUs.empty()) return 0;
        const auto at = static_cast<size_t>(share * static_cast<double>(latenciesUs.size()));
        return latenciesUs[std::min(at, latenciesUs.size() - 1)];
    }
};

json toJson(const Measured& m) {
    const rsp::SenderCounters& s = m.report.sender;
    json j{{"role", m.role}, {"bytes", m.bytes}, {"seconds", m.elapsedS}, {"mbit", m.mbit()}, {"cpuSeconds", m.cpuS},
        {"cpuSecondsPerGB", m.cpuPerGB()}, {"datagrams", s.datagrams}, {"parity", s.rows}, {"resent", s.resent}, {"polls", s.polls},
        {"feedback", s.feedback}, {"sendings", m.report.sendings}, {"sendingBy", m.report.sendingBy},
        {"socketDropped", m.report.socketDropped}, {"refused", m.report.refused.all()}};
    if (!m.latenciesUs.empty()) {
        j["latencyUs"] = {{"p50", m.latencyUs(0.5)}, {"p90", m.latencyUs(0.9)}, {"p99", m.latencyUs(0.99)}, {"max", m.latenciesUs.back()},
            {"count", m.latenciesUs.size()}};
    }
    for (const auto& stream : m.report.streams) {
        j["streams"].push_back({{"from", stream.from}, {"datagrams", stream.received.datagrams}, {"recovered", stream.received.recovered},
            {"duplicates", stream.received.duplicates}, {"lost", stream.lost}, {"feedback", stream.feedback}});
    }
    for (const auto& member : m.report.members) {
        j["members"].push_back({{"id", member.id}, {"address", member.info.address}, {"multicast", member.info.multicast},
            {"roundTripUs", static_cast<double>(member.state.roundTripNs) * 1e-3}, {"lost", member.state.lost}, {"dropped", member.state.dropped}});
    }
    return j;
}

void printTable(const Measured& m) {
    const rsp::SenderCounters& s = m.report.sender;
    fmt::print("{}: {} bytes in {:.3f} s = {:.1f} Mbit/s, CPU {:.2f} s per GB\n", m.role, m.bytes, m.elapsedS, m.mbit(), m.cpuPerGB());
    if (!m.latenciesUs.empty()) {
        fmt::print("  until all have a message: p50 {:.0f} us, p90 {:.0f}, p99 {:.0f}, longest {:.0f} ({} messages)\n", m.latencyUs(0.5),
            m.latencyUs(0.9), m.latencyUs(0.99), m.latenciesUs.back(), m.latenciesUs.size());
    }
    if (s.datagrams > 0) {
        fmt::print("  {} datagrams in {} sendings by {}; {} of parity, {} sent again, {} polls, {} answers\n", s.datagrams, m.report.sendings,
            m.report.sendingBy, s.rows, s.resent, s.polls, s.feedback);
    }
    for (const auto& member : m.report.members) {
        fmt::print("  member {} at {}: {}, round trip {:.0f} us, lost {}, dropped by its socket {}\n", member.id, member.info.address,
            member.info.multicast ? "multicast" : "through the host's connection", static_cast<double>(member.state.roundTripNs) * 1e-3,
            member.state.lost, member.state.dropped);
    }
    for (const auto& stream : m.report.streams) {
        if (stream.received.datagrams == 0) continue;
        fmt::print("  {} datagrams, {} put back from parity, {} twice, {} lost on the way\n", stream.received.datagrams,
            stream.received.recovered, stream.received.duplicates, stream.lost);
    }
}

void print(const Measured& m, bool asJson) {
    if (asJson) fmt::print("{}\n", toJson(m).dump());
    else printTable(m);
    std::fflush(stdout);
}

Result<void> sendMessages(Group& group, const NetperfArguments& a, uint64_t messageBytes, Deadline deadline, Measured& m) {
    const std::vector<std::byte> message(messageBytes, std::byte{7});
    for (size_t i = 0; i < a.count + kWarmUp; ++i) {
        const double began = nowS();
        if (auto r = group.write(message, deadline); !r) return r;
        group.flush();
        if (auto r = group.waitArrived(deadline); !r) return r;
        if (i >= kWarmUp) m.latenciesUs.push_back((nowS() - began) * 1e6);
        m.bytes += messageBytes;
    }
    std::ranges::sort(m.latenciesUs);
    return {};
}

Result<void> sendBytes(Group& group, uint64_t bytes, Deadline deadline, Measured& m) {
    const std::vector<std::byte> piece(kPieceBytes, std::byte{5});
    while (m.bytes < bytes) {
        const size_t count = std::min<uint64_t>(piece.size(), bytes - m.bytes);
        if (auto r = group.write(std::span(piece).first(count), deadline); !r) return r;
        m.bytes += count;
    }
    group.flush();
    return group.waitArrived(deadline);
}

Result<Measured> send(Group& group, const Plan& plan, const NetperfArguments& a) {
    Measured m;
    m.role = "sender";
    const Deadline deadline = Deadline::inMs(static_cast<int64_t>(a.withinSeconds * 1000));
    if (auto r = group.waitForMembers(a.members, deadline); !r) return r.error();
    const double began = nowS();
    const double cpuBegan = cpuS();
    auto r = plan.messageBytes > 0 ? sendMessages(group, a, plan.messageBytes, deadline, m) : sendBytes(group, plan.bytes, deadline, m);
    if (!r) return r.error();
    m.elapsedS = nowS() - began;
    m.cpuS = cpuS() - cpuBegan;
    m.report = group.report();
    return m;
}

// Until the sender leaves. The time is that of the first byte to the last.
Result<Measured> receive(Group& group, const NetperfArguments& a) {
    Measured m;
    m.role = "receiver " + std::to_string(group.self());
    std::vector<std::byte> piece(kPieceBytes);
    double firstS = 0;
    double cpuBegan = 0;
    while (true) {
        auto count = group.read(rsp::kHost, piece, Deadline::inMs(static_cast<int64_t>(a.withinSeconds * 1000)));
        if (!count && m.bytes == 0) return count.error();
        if (!count || *count == 0) break; // the sender has what it wanted
        const double now = nowS();
        if (m.bytes == 0) {
            firstS = now;
            cpuBegan = cpuS();
        }
        m.bytes += *count;
        m.elapsedS = now - firstS;
        m.cpuS = cpuS() - cpuBegan;
        m.report = group.report();
    }
    return m;
}

int failed(const std::string& why) {
    fmt::print(stderr, "mural netperf: {}\n", why);
    return 1;
}

int sendRole(const Plan& plan, const NetperfArguments& a) {
    auto group = Group::host(plan.options);
    if (!group) return failed(group.error().message);
    if (!a.asJson) fmt::print("waiting for {} receivers; start each with: mural netperf receive --control HOST:PORT --secret-file …, the host listens at {}\n", a.members, (*group)->controlAddress());
    std::fflush(stdout);
    auto m = send(**group, plan, a);
    if (!m) return failed(m.error().message);
    print(*m, a.asJson);
    return 0;
}

int receiveRole(const Plan& plan, const NetperfArguments& a) {
    auto group = Group::join(plan.options, Deadline::inMs(static_cast<int64_t>(a.withinSeconds * 1000)));
    if (!group) return failed(group.error().message);
    auto m = receive(**group, a);
    if (!m) return failed(m.error().message);
    print(*m, a.asJson);
    return 0;
}

// All in one process, over the loopback.
int localRole(const Plan& plan, const NetperfArguments& a) {
    auto host = Group::host(plan.options);
    if (!host) return failed(host.error().message);
    rsp::GroupOptions join = plan.options;
    join.control = (*host)->controlAddress();
    std::vector<std::unique_ptr<Group>> members;
    for (unsigned i = 0; i < a.members; ++i) {
        auto member = Group::join(join, Deadline::inMs(10'000));
        if (!member) return failed(member.error().message);
        members.push_back(std::move(*member));
    }
    std::vector<std::thread> readers;
    std::vector<Measured> received(a.members);
    for (size_t i = 0; i < members.size(); ++i) {
        readers.emplace_back([&, i] {
            if (auto m = receive(*members[i], a)) received[i] = std::move(*m);
        });
    }
    auto sent = send(**host, plan, a);
    host->reset();
    for (auto& r : readers) r.join();
    if (!sent) return failed(sent.error().message);
    print(*sent, a.asJson);
    for (const Measured& m : received) print(m, a.asJson);
    return 0;
}

} // namespace

void describeNetperf(CLI::App& command, NetperfArguments& a) {
    command.add_option("ROLE", a.role, "send, receive, or local: all on this machine")->check(CLI::IsMember({"send", "receive", "local"}));
    command.add_option("--members", a.members, "receivers to wait for")->check(CLI::Range(1, 1000));
    command.add_option("--bytes", a.bytes, "how much is sent: 64M")->type_name("SIZE");
    command.add_option("--message", a.message, "send messages of this size instead, each when all have the one before")->type_name("SIZE");
    command.add_option("--count", a.count, "so many messages")->check(CLI::Range(1, 10'000'000));
    command.add_option("--rate", a.rate, "at most: 200mbit, 1gbit; 0: nine tenths of what the card tells")->type_name("RATE");
    command.add_option("--group", a.group, "multicast address and port")->type_name("ADDRESS:PORT");
    command.add_option("--interface", a.interface, "network interface, by name or address");
    command.add_option("--control", a.control, "send: where to listen; receive: where the sender listens")->type_name("HOST:PORT");
    command.add_option("--secret-file", a.secretFile, "file with the secret that both ends know; -: standard input");
    command.add_option("--seal", a.seal, "auto (encrypted), siphash, aes-256-gcm, chacha20-poly1305, none");
    command.add_option("--datagram", a.datagramBytes, "bytes of a datagram; 0: what the interface carries whole")->check(CLI::Range(0, 65'000));
    command.add_option("--window", a.window, "datagrams under way at most, a power of two");
    command.add_option("--within", a.withinSeconds, "give up after so many seconds")->type_name("SECONDS")->check(CLI::Range(0.1, 86'400.0));
    command.add_flag("--no-parity", a.noParity, "mend losses by sending again, to compare");
    command.add_flag("--no-multicast", a.noMulticast, "receive: through the host's connection");
    command.add_flag("--json", a.asJson, "one line of JSON for each end");
}

int netperfCommand(const NetperfArguments& arguments) {
    auto plan = planOf(arguments);
    if (!plan) {
        failed(plan.error().message);
        return launch::kExitUsage;
    }
    if (arguments.role == "send") return sendRole(*plan, arguments);
    if (arguments.role == "receive") return receiveRole(*plan, arguments);
    return localRole(*plan, arguments);
}

} // namespace mural::cli
