#include "tools/mural/network/host_survey.hpp"

#include <algorithm>
#include <poll.h>

#include "transport/tcp/socket_address.hpp"

namespace mural::cli {

namespace {

using nlohmann::json;

constexpr int64_t kAnswerMs = 10'000;
constexpr int64_t kJoinMs = 15'000;
constexpr int64_t kArriveMs = 20'000; // timeout for complete delivery after the end of a stream
constexpr int64_t kUnderWayMs = 150;  // transit time of a probe
constexpr unsigned kCopies = 5;       // copies of each probe: one arrival suffices
constexpr int kBetweenProbesMs = 1;
constexpr size_t kExactBytes = 4; // resolution of the largest size
constexpr size_t kPieceBytes = 64 * 1024;
constexpr size_t kMinSessionBytes = 512; // least size of a session's datagrams

// Common packet sizes: tunnels, PPPoE, Ethernet, jumbo frames.
constexpr size_t kKnownPackets[] = {1280, 1400, 1450, 1492, 1500, 2304, 4352, 8192, 9000};

std::string textOf(const json& j, const char* name) {
    const auto found = j.find(name);
    return found != j.end() && found->is_string() ? found->get<std::string>() : std::string();
}

uint64_t numberOf(const json& j, const char* name) {
    const auto found = j.find(name);
    return found != j.end() && found->is_number_unsigned() ? found->get<uint64_t>() : 0;
}

void takeTroubles(const json& answer, HostMeasured& m) {
    const auto list = answer.find("troubles");
    if (list == answer.end() || !list->is_array()) return;
    for (size_t i = 0; i < std::min(list->size(), m.paths.size()); ++i) {
        if ((*list)[i].is_string() && !(*list)[i].get<std::string>().empty())
            m.paths[i].trouble = "there: " + (*list)[i].get<std::string>();
    }
}

} // namespace

Result<void> HostSurvey::greet(Deadline deadline) {
    auto hello = process_.receive(deadline);
    if (!hello) return hello.error();
    m_.version = textOf(*hello, "version");
    m_.reached = textOf(*hello, "reached");
    m_.own = textOf(*hello, "own");
    m_.unreachedWhy = textOf(*hello, "why");
    if (hello->contains("facts") && (*hello)["facts"].is_object()) m_.facts = machineFactsFrom((*hello)["facts"]);
    takeTroubles(*hello, m_);
    if (m_.reached.empty()) return {};
    auto single = numericAddress(m_.own, static_cast<uint16_t>(numberOf(*hello, "port")));
    if (!single) return Error{"the host sent no address"};
    single_ = *single;
    return {};
}

Result<void> HostSurvey::measure() {
    if (auto r = probe(); !r) return r;
    if (auto r = stream(); !r) m_.streamFailure = r.error().message;
    return probeAgain();
}

Result<void> HostSurvey::probe() {
    std::vector<size_t> sizes{kMinProbeBytes};
    if (auto r = probeThere(sizes, {std::begin(kProbePaths), std::end(kProbePaths)}); !r) return r;
    if (auto r = probeBack(); !r) return r;
    for (const ProbePath path : {ProbePath::Single, ProbePath::Group}) {
        if (!m_.path(path).to) continue;
        if (auto r = findLargest(path); !r) return r;
    }
    for (const ProbePath path : kProbePaths) {
        if (m_.path(path).trouble.empty()) m_.path(path).trouble = sockets_.trouble(path);
    }
    return {};
}

// Records arrivals in m_, and the largest size of the first method in seenBytes_.
Result<void> HostSurvey::probeThere(const std::vector<size_t>& sizes, const std::vector<ProbePath>& paths) {
    for (unsigned copy = 0; copy < kCopies; ++copy) {
        for (const ProbePath path : paths) {
            for (const size_t size : sizes) {
                sockets_.send(path, size, single_);
                poll(nullptr, 0, kBetweenProbesMs);
            }
        }
    }
    poll(nullptr, 0, kUnderWayMs);
    auto answer = process_.query({{"do", "seen"}}, Deadline::inMs(kAnswerMs));
    if (!answer) return answer.error();
    seenBytes_ = 0;
    const auto seen = answer->find("seen");
    if (seen == answer->end() || !seen->is_array()) return Error{"the host sent no list of received datagrams"};
    for (const json& each : *seen) {
        const uint64_t number = each.is_object() ? numberOf(each, "path") : ~uint64_t{0};
        if (number >= m_.paths.size()) continue;
        const auto path = static_cast<ProbePath>(number);
        const size_t size = numberOf(each, "size");
        m_.path(path).to = m_.path(path).toLater = true;
        m_.path(path).largestBytes = std::max(m_.path(path).largestBytes, size);
        if (path == paths.front()) seenBytes_ = std::max(seenBytes_, size);
    }
    return {};
}

Result<void> HostSurvey::probeBack() {
    (void)sockets_.take();
    const json order{{"do", "send"},
                     {"to", m_.reached},
                     {"port", sockets_.port()},
                     {"sizes", {kMinProbeBytes}},
                     {"copies", kCopies}};
    auto answer = process_.query(order, Deadline::inMs(kAnswerMs));
    if (!answer) return answer.error();
    takeTroubles(*answer, m_);
    (void)sockets_.listen(Deadline::inMs(kUnderWayMs));
    for (const auto& [probe, count] : sockets_.take()) m_.path(probe.path).from = true;
    return {};
}

// Tries common sizes first, then bisects between the largest arrival and the smallest loss.
Result<void> HostSurvey::findLargest(ProbePath path) {
    // Interfaces accept packets somewhat larger than their MTU, but cannot send replies of that size.
    const size_t hostMtuBytes = m_.facts.mtuBytes > plan_.headerBytes + kMinProbeBytes
                                    ? m_.facts.mtuBytes - plan_.headerBytes
                                    : plan_.cardBytes;
    const size_t maximum = std::min(plan_.cardBytes, hostMtuBytes);
    std::vector<size_t> sizes{kMinProbeBytes};
    for (const size_t packet : kKnownPackets) {
        if (packet - plan_.headerBytes < maximum) sizes.push_back(packet - plan_.headerBytes);
    }
    sizes.push_back(maximum);
    if (auto r = probeThere(sizes, {path}); !r) return r;
    size_t comes = seenBytes_;
    if (comes >= maximum || comes == 0) return {};
    size_t comesNot = *std::ranges::upper_bound(sizes, comes);
    while (comesNot - comes > kExactBytes) {
        const size_t middle = comes + (comesNot - comes) / 2;
        if (auto r = probeThere({middle}, {path}); !r) return r;
        (seenBytes_ == middle ? comes : comesNot) = middle;
    }
    return {};
}

Result<void> HostSurvey::stream() {
    rsp::GroupOptions options = plan_.group;
    // Streams at the largest size that arrives, which is the size of a session configured for this network.
    const size_t largest = m_.path(ProbePath::Group).largestBytes;
    if (largest >= kMinSessionBytes && largest < plan_.cardBytes) options.datagramBytes = largest;
    auto group = rsp::Group::host(options);
    if (!group) return group.error();
    auto where = splitHostPort((*group)->controlAddress());
    if (!where) return where.error();
    const bool brackets = m_.reached.find(':') != std::string::npos;
    const std::string control = (brackets ? "[" + m_.reached + "]" : m_.reached) + ":" + std::to_string(where->port);
    auto joined = process_.query({{"do", "join"}, {"control", control}}, Deadline::inMs(kJoinMs));
    if (!joined) return joined.error();
    if (!joined->contains("joined") || (*joined)["joined"] != true)
        return Error{"the host could not join the group: " + textOf(*joined, "why")};
    auto r = streamTo(**group);
    group->reset();
    auto left = process_.query({{"do", "leave"}}, Deadline::inMs(kAnswerMs));
    if (!r) return r;
    if (!left) return left.error();
    m_.queueDropped = numberOf(*left, "queueDropped");
    return {};
}

Result<void> HostSurvey::streamTo(rsp::Group& group) {
    if (auto r = group.waitForMembers(1, Deadline::inMs(kJoinMs)); !r) return r;
    const std::vector<std::byte> piece(kPieceBytes);
    const int64_t beganNs = monotonicNowNs();
    const Deadline writing = Deadline::inMs(static_cast<int64_t>(plan_.seconds * 1000));
    uint64_t bytes = 0;
    do {
        if (auto r = group.write(piece, Deadline::inMs(kArriveMs)); !r) return r;
        bytes += piece.size();
    } while (!writing.passed());
    group.flush();
    if (auto r = group.waitArrived(Deadline::inMs(kArriveMs)); !r) return r;
    const double tookS = static_cast<double>(monotonicNowNs() - beganNs) * 1e-9;
    const rsp::GroupReport report = group.report();
    // A group without members discards its stream at any rate, so the measured rate would be meaningless.
    if (report.members.size() != 1)
        return Error{
            "the host was evicted from the group during the stream: it sent no feedback or did not receive the data"};
    const auto& member = report.members.front();
    m_.multicast = member.info.multicast;
    m_.datagrams = report.sender.datagrams;
    m_.bytesPerS = static_cast<double>(bytes) / tookS;
    const double sent = static_cast<double>(std::max<uint64_t>(1, report.sender.datagrams));
    const uint32_t onTheWay = member.state.lost - std::min(member.state.lost, member.state.dropped);
    m_.lostShare = std::min(1.0, onTheWay / sent);
    m_.droppedShare = std::min(1.0, member.state.dropped / sent);
    return {};
}

Result<void> HostSurvey::probeAgain() {
    if (m_.reached.empty()) return {};
    const bool arrived = m_.path(ProbePath::Group).to;
    for (PathMeasured& path : m_.paths) path.toLater = false;
    if (!arrived) return {};
    return probeThere({kMinProbeBytes}, {ProbePath::Group});
}

} // namespace mural::cli
