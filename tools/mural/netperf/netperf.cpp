#include "tools/mural/netperf/netperf.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <sys/resource.h>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/base/quick_clock.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/netperf/netperf_measured.hpp"
#include "tools/mural/netperf/stream_pattern.hpp"
#include "transport/rsp/group.hpp"
#include "transport/rsp/group_description.hpp"
#include "transport/rsp/group_text.hpp"

namespace mural::cli {

namespace {

using rsp::Group;

constexpr size_t kPieceBytes = 256 * 1024;
constexpr size_t kPieces = 128; // pieces of a stream per read
constexpr size_t kWarmUp = 20;  // messages before the measurement

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6; }

double cpuS() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double nowS() { return static_cast<double>(quickNowNs()) * 1e-9; }

struct Plan {
    rsp::GroupOptions options;
    uint64_t bytes = 0;
    uint64_t messageBytes = 0;
};

// Options from --stream, whose text may include address and secret, and from separate options.
Result<rsp::GroupOptions> optionsOfStream(const NetperfArguments& a, bool& needsSecret) {
    auto description = parseConnectionDescription(a.stream);
    if (!description) return description.error();
    if (description->kind != ConnectionDescription::Kind::Rsp)
        return Error{"--stream \"" + a.stream +
                     "\" is not a multicast group; use rsp://239.255.77.85:4277?parameter=value&…"};
    auto options = rsp::groupOptionsOf(*description);
    if (!options) return options.error();
    if (!description->parameters.contains("control")) options->control = a.control;
    needsSecret = !description->parameters.contains("secret");
    return options;
}

Result<rsp::GroupOptions> optionsOf(const NetperfArguments& a) {
    rsp::GroupOptions o;
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
    auto window = rsp::parseSize(a.window);
    if (!window) return window.error();
    if (*window < 64 || *window > 65'536 || (*window & (*window - 1)) != 0)
        return Error{"--window must be a power of two from 64 to 65536"};
    o.windowDatagrams = static_cast<uint32_t>(*window);
    return o;
}

Result<Plan> planOf(const NetperfArguments& a) {
    bool needsSecret = true;
    auto options = a.stream.empty() ? optionsOf(a) : optionsOfStream(a, needsSecret);
    auto bytes = rsp::parseSize(a.bytes);
    auto message = rsp::parseSize(a.message);
    if (!options) return options.error();
    if (!bytes) return bytes.error();
    if (!message) return message.error();
    Plan plan{*options, *bytes, *message};
    rsp::GroupOptions& o = plan.options;
    if (a.role == "local") {
        if (o.interface.empty()) o.interface = "lo";
        o.control = "127.0.0.1:0";
        return plan;
    }
    if (!needsSecret) return plan;
    if (a.secretFile.empty())
        return Error{
            "--secret-file (or secret=FILE in --stream) is required; sender and receivers authenticate with it"};
    auto secret = rsp::readSecret(a.secretFile);
    if (!secret) return secret.error();
    o.secret = *secret;
    return plan;
}

Result<void> sendMessages(Group& group, const NetperfArguments& a, uint64_t messageBytes, Deadline deadline,
                          Measured& m) {
    std::vector<std::byte> message(messageBytes);
    for (size_t i = 0; i < a.count + kWarmUp; ++i) {
        if (!a.unchecked) fillPattern(message, i * messageBytes);
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

Result<void> sendBytes(Group& group, const NetperfArguments& a, uint64_t bytes, Deadline deadline, Measured& m) {
    std::vector<std::byte> piece(kPieceBytes);
    while (m.bytes < bytes) {
        const size_t count = std::min<uint64_t>(piece.size(), bytes - m.bytes);
        if (!a.unchecked) fillPattern(std::span(piece).first(count), m.bytes);
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
    const size_t membersAtFirst = group.members().size();
    const double began = nowS();
    const double cpuBegan = cpuS();
    auto r = plan.messageBytes > 0 ? sendMessages(group, a, plan.messageBytes, deadline, m)
                                   : sendBytes(group, a, plan.bytes, deadline, m);
    if (!r) return r.error();
    m.elapsedS = nowS() - began;
    m.cpuS = cpuS() - cpuBegan;
    m.report = group.report();
    m.membersLost = membersAtFirst - std::min(membersAtFirst, m.report.members.size());
    return m;
}

// Receives until the sender leaves, the connection breaks, or this end leaves. Times from the first byte to the last.
Result<Measured> receive(Group& group, const NetperfArguments& a) {
    Measured m;
    m.role = "receiver " + std::to_string(group.self());
    m.timeline = Timeline(static_cast<int64_t>(a.timelineMs) * kNsPerMs);
    PatternCheck check;
    const Deadline leave =
        a.leaveAfterSeconds > 0 ? Deadline::inMs(static_cast<int64_t>(a.leaveAfterSeconds * 1000)) : Deadline::never();
    const auto withinNs = static_cast<int64_t>(a.withinSeconds * kNsPerS);
    double firstS = 0;
    double cpuBegan = cpuS();
    std::array<std::span<const std::byte>, kPieces> pieces;
    while (!leave.passed()) {
        auto count = group.view(rsp::kHost, pieces, Deadline::at(quickNowNs() + leave.leftNs(withinNs) + kNsPerMs));
        if (!count && !leave.passed()) m.cut = count.error().message;
        if (!count || *count == 0) break; // the sender has finished
        const int64_t nowNs = quickNowNs();
        const double now = static_cast<double>(nowNs) * 1e-9;
        if (m.bytes == 0) {
            firstS = now;
            cpuBegan = cpuS();
        }
        size_t bytes = 0;
        for (const auto piece : std::span(pieces).first(*count)) {
            if (!a.unchecked) check.take(piece);
            bytes += piece.size();
        }
        m.timeline.add(bytes, nowNs);
        m.bytes += bytes;
        m.elapsedS = now - firstS;
        group.consume(rsp::kHost, bytes);
    }
    m.cpuS = cpuS() - cpuBegan;
    m.beganAt = check.beganAt();
    m.wrong = check.fault();
    m.report = group.report();
    return m;
}

int failed(const std::string& why) {
    fmt::print(stderr, "mural netperf: {}\n", why);
    return 1;
}

std::string faultOf(const Measured& m) {
    return "received data differs from sent data: " + m.wrong +
           "; unless --seal is none, please report this as a fault of mural";
}

int sendRole(const Plan& plan, const NetperfArguments& a) {
    auto group = Group::host(plan.options);
    if (!group) return failed(group.error().message);
    // Not part of the results.
    fmt::print(stderr,
               "waiting for {} receivers; start each with: mural netperf receive --control HOST:PORT --secret-file …; "
               "the host listens on {}\n",
               a.members, (*group)->controlAddress());
    auto m = send(**group, plan, a);
    if (!m) return failed(m.error().message);
    print(*m, a.asJson);
    return 0;
}

int receiveRole(const Plan& plan, const NetperfArguments& a) {
    const int64_t joinBeganNs = monotonicNowNs();
    auto group = Group::join(plan.options, Deadline::inMs(static_cast<int64_t>(a.withinSeconds * 1000)));
    if (!group) return failed(group.error().message);
    const int64_t joinedNs = monotonicNowNs();
    auto m = receive(**group, a);
    if (!m) return failed(m.error().message);
    m->joinBeganNs = joinBeganNs;
    m->joinedNs = joinedNs;
    print(*m, a.asJson);
    if (!m->wrong.empty()) return failed(faultOf(*m));
    return m->cut.empty() ? 0
                          : failed("the stream was cut off after " + std::to_string(m->bytes) + " bytes: " + m->cut);
}

// Runs all roles in one process over the loopback.
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
    for (const Measured& m : received) {
        print(m, a.asJson);
        if (!m.cut.empty()) return failed(m.role + ": " + m.cut);
        if (!m.wrong.empty()) return failed(m.role + ": " + faultOf(m));
    }
    return 0;
}

} // namespace

void describeNetperf(CLI::App& command, NetperfArguments& a) {
    command.add_option("ROLE", a.role, "send, receive, or local: all roles on this machine")
        ->check(CLI::IsMember({"send", "receive", "local"}));
    command.add_option("--members", a.members, "number of receivers to wait for")->check(CLI::Range(1, 1000));
    command.add_option("--bytes", a.bytes, "amount to send (64M)")->type_name("SIZE");
    command
        .add_option("--message", a.message,
                    "send messages of this size instead; each waits for the arrival of the previous one")
        ->type_name("SIZE");
    command.add_option("--count", a.count, "number of messages")->check(CLI::Range(1, 10'000'000));
    auto* stream = command.add_option("--stream", a.stream,
                                      "the group as a description, rsp://GROUP:PORT?parameter=value&…, instead of "
                                      "separate options (docs/reference/connections.md lists them)");
    command.add_option("--rate", a.rate, "maximum rate: 200mbit, 1gbit; 0: nine tenths of the card's rate")
        ->type_name("RATE");
    command.add_option("--group", a.group, "multicast address and port")->type_name("ADDRESS:PORT");
    command.add_option("--interface", a.interface, "network interface, name or address");
    command.add_option("--control", a.control, "send: address to listen on; receive: address of the sender")
        ->type_name("HOST:PORT");
    command.add_option("--secret-file", a.secretFile, "file with the shared secret; -: standard input");
    command.add_option("--seal", a.seal, "auto (encrypted), siphash, aes-256-gcm, chacha20-poly1305, none");
    command.add_option("--datagram", a.datagramBytes, "bytes per datagram; 0: the largest without fragmentation")
        ->check(CLI::Range(0, 65'000));
    command.add_option("--window", a.window, "maximum number of unacknowledged datagrams, a power of two");
    command.add_option("--within", a.withinSeconds, "time limit")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.1, 86'400.0));
    command.add_option("--leave-after", a.leaveAfterSeconds, "receive: leave the group this long after joining")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.0, 86'400.0));
    command
        .add_option("--timeline", a.timelineMs, "with --json: also report the bytes of every interval of this length")
        ->type_name("MS")
        ->check(CLI::Range(0, 10'000));
    command.add_flag("--unchecked", a.unchecked,
                     "do not generate or compare data, at both ends; measures the transport alone");
    command.add_flag("--no-parity", a.noParity, "repair losses by retransmission only, for comparison");
    command.add_flag("--no-multicast", a.noMulticast, "receive: use the host's TCP connection");
    command.add_flag("--json", a.asJson, "print one line of JSON per end");
    for (const char* single :
         {"--rate", "--group", "--interface", "--seal", "--datagram", "--window", "--no-parity", "--no-multicast"})
        stream->excludes(command.get_option(single));
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
