#include "tools/mural/network/network_doctor.hpp"

#include <csignal>
#include <unistd.h>

#include <CLI/App.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/doctor/check_report.hpp"
#include "tools/mural/network/network_survey.hpp"
#include "tools/mural/network/network_verdict.hpp"

namespace mural::cli {

namespace {

using nlohmann::json;

std::string reachOf(const HostMeasured& h) {
    if (!h.failure.empty() || h.reached.empty()) return "not reached";
    if (h.streamFailure.empty()) return h.multicast ? "multicast" : "TCP only";
    return h.path(ProbePath::Group).to ? "multicast" : h.path(ProbePath::Single).to ? "no multicast" : "TCP only";
}

size_t largestOf(const HostMeasured& h) {
    return h.path(ProbePath::Group).to ? h.path(ProbePath::Group).largestBytes : h.path(ProbePath::Single).largestBytes;
}

void printTable(const std::vector<HostMeasured>& hosts) {
    fmt::print("{:<20} {:<12} {:>10} {:>12} {:>8} {:>10}\n", "host", "reached from", "datagram", "rate", "lost",
               "buffer");
    for (const HostMeasured& h : hosts) {
        const bool streamed = h.failure.empty() && h.streamFailure.empty() && !h.reached.empty();
        fmt::print("{:<20} {:<12} {:>10} {:>12} {:>8} {:>10}\n", h.host, reachOf(h),
                   largestOf(h) > 0 ? fmt::format("{} B", largestOf(h)) : "-",
                   streamed ? fmt::format("{:.0f} Mbit/s", h.bytesPerS * 8e-6) : "-",
                   streamed ? fmt::format("{:.2f} %", h.lostShare * 100) : "-",
                   h.facts.bufferBytes > 0
                       ? fmt::format("{:.3g} MiB", static_cast<double>(h.facts.bufferBytes) / (1 << 20))
                       : "-");
    }
}

json hostJson(const HostMeasured& h, const std::vector<Check>& checks) {
    json j{{"host", h.host},
           {"reachedBy", reachOf(h)},
           {"failure", h.failure},
           {"version", h.version},
           {"connection", {{"to", h.reached}, {"from", h.own}, {"why", h.unreachedWhy}}},
           {"machine", toJson(h.facts)},
           {"checks", toJson(checks)}};
    constexpr const char* kNames[] = {"single", "group", "linkLocal"};
    for (const ProbePath w : kProbePaths) {
        const PathMeasured& path = h.path(w);
        j["ways"][kNames[static_cast<size_t>(w)]] = {{"arrivesThere", path.to},
                                                     {"arrivesHere", path.from},
                                                     {"atTheEnd", path.toLater},
                                                     {"largestBytes", path.largestBytes},
                                                     {"trouble", path.trouble}};
    }
    j["stream"] = {{"failure", h.streamFailure},    {"multicast", h.multicast}, {"mbit", h.bytesPerS * 8e-6},
                   {"datagrams", h.datagrams},      {"lostShare", h.lostShare}, {"droppedShare", h.droppedShare},
                   {"queueDropped", h.queueDropped}};
    return j;
}

} // namespace

CLI::Option* describeNetworkDoctor(CLI::App& doctor, NetworkArguments& a) {
    CLI::Option* network = doctor.add_option(
        "--network", a.hosts, "test the network between this machine and these hosts with a test process on each");
    network->type_name("[H1,H2]")->expected(0, 1);
    doctor
        .add_option("--launch", a.launchCommand,
                    "with --network or --nodes: command that runs a command on a host (ssh -o BatchMode=yes)")
        ->type_name("CMD");
    doctor
        .add_option("--remote-mural", a.remoteMural,
                    "with --network or --nodes: path of mural on the hosts (the local path)")
        ->type_name("PATH");
    doctor.add_option("--group", a.group, "with --network or --nodes: multicast address and port (239.255.77.85:4277)")
        ->type_name("ADDRESS:PORT");
    doctor
        .add_option("--interface", a.interface,
                    "with --network or --nodes: interface to send on, name or address (the one towards the first host)")
        ->type_name("NAME");
    doctor
        .add_option("--rate", a.rate, "with --network: maximum rate, such as 900mbit (nine tenths of the card's rate)")
        ->type_name("RATE")
        ->needs(network);
    doctor.add_option("--seconds", a.seconds, "with --network: seconds of streaming to each host (1)")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.1, 60.0))
        ->needs(network);
    return network;
}

int networkDoctorCommand(const NetworkArguments& arguments, bool asJson) {
    launch::rememberSignals();
    std::signal(SIGPIPE, SIG_IGN); // a host's process may end at any time
    const bool terminal = !asJson && isatty(STDERR_FILENO) == 1;
    const auto survey = surveyNetwork(arguments, [&](const std::string& host) {
        if (terminal) fmt::print(stderr, "testing {} ...\n", host);
    });
    if (!survey) {
        fmt::print(stderr, "mural doctor --network: {}\n", survey.error().message);
        return launch::kExitUsage;
    }
    std::vector<Check> all = judgeHere(survey.value().here);
    json report{{"machine", toJson(survey.value().here.facts)}, {"checks", toJson(all)}, {"hosts", json::array()}};
    for (const HostMeasured& h : survey.value().hosts) {
        const auto checks = judgeHost(survey.value().here, h);
        report["hosts"].push_back(hostJson(h, checks));
        all.insert(all.end(), checks.begin(), checks.end());
    }
    const bool good = usable(all);
    report["usable"] = good;
    if (asJson) {
        fmt::print("{}\n", jsonText(report, 2));
    } else {
        printTable(survey.value().hosts);
        printChecks(all);
        fmt::print("{}\n", good ? "The network is ready for Mural."
                                : "The network needs changes: fix the lines that begin with \"bad\".");
    }
    return good ? 0 : 1;
}

} // namespace mural::cli
