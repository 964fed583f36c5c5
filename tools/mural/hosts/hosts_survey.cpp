#include "tools/mural/hosts/hosts_survey.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <ctime>
#include <memory>
#include <mutex>
#include <netinet/in.h>
#include <poll.h>
#include <thread>

#include <nlohmann/json.hpp>

#include "nodes/session/session_secret.hpp"
#include "nodes/session/stream_build.hpp"
#include "nodes/swap_barrier/clock_offset.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/network/host_survey.hpp"
#include "tools/mural/network/probe_command.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural::cli {

namespace {

using nlohmann::json;

constexpr int64_t kAllMs = 14'000;
constexpr int64_t kHelloMs = 10'000; // of the launch command, with the host's tests of its way here
constexpr int64_t kReplyMs = 10'000;
constexpr int64_t kRateMs = 200;         // in each direction
constexpr int64_t kInspectionMs = 6'000; // kept for what follows the rates
constexpr int kClockProbes = 9;
constexpr size_t kIpv4HeaderBytes = 28;
constexpr size_t kIpv6HeaderBytes = 48;
constexpr size_t kLargestDatagramBytes = 8972; // as RSP

int64_t timeOfDayNs() {
    timespec t{};
    clock_gettime(CLOCK_REALTIME, &t);
    return static_cast<int64_t>(t.tv_sec) * kNsPerS + t.tv_nsec;
}

std::string wordIn(const json& j, const char* name) {
    const auto found = j.find(name);
    return found != j.end() && found->is_string() ? found->get<std::string>() : std::string();
}
double realIn(const json& j, const char* name) {
    const auto found = j.find(name);
    return found != j.end() && found->is_number() ? found->get<double>() : 0.0;
}

// Common to all examinations.
struct Here {
    std::string group; // as the user writes it
    SocketAddress groupAddress;
    rsp::NetworkInterface interface;
    FileDescriptor listening; // hosts test their connection to this machine here
    SurveyPlan network;
    Deadline deadline = Deadline::inMs(kAllMs);
    std::mutex rates; // held while one host's rate is measured
};

// The examination of one host, in a thread of its own after start().
class HostExamination {
public:
    HostExamination(Here& here, const InspectionPlan& inspection, HostExamined& into)
        : here_(here), inspection_(inspection), x_(into) {}

    // Starts the host's process. Its parent must be the main thread, whose end is the end of the process.
    void start(const std::vector<std::string>& command) {
        auto process = ProbeProcess::start(command);
        if (process)
            process_ = std::move(*process);
        else
            x_.failure = process.error().message;
    }
    void run() {
        if (!process_) return;
        if (auto r = greet(); !r) {
            x_.failure = r.error().message;
            return;
        }
        HostSurvey survey(here_.network, *sockets_, *process_, x_.network);
        if (auto r = survey.greet(Deadline::inMs(kHelloMs)); !r) {
            x_.failure = r.error().message;
            return;
        }
        measureClock();
        if (!x_.network.reached.empty()) {
            if (auto r = survey.probe(); !r) return fail("datagrams", r.error());
            if (!measureRates()) return;
        }
        inspect();
    }
    // Ends the examination from another thread.
    void abandon() {
        if (process_) process_->abandon();
    }

private:
    // Sends the first line.
    Result<void> greet() {
        const auto secret = makeSessionSecret(), number = makeSessionSecret();
        if (!secret) return secret.error();
        if (!number) return number.error();
        uint64_t survey = 0;
        std::memcpy(&survey, number.value().data(), sizeof survey);
        const int family = here_.groupAddress.family();
        auto sockets = ProbeSockets::open(here_.groupAddress, here_.interface, survey, true);
        if (!sockets) return sockets.error();
        sockets_ = std::make_unique<ProbeSockets>(std::move(*sockets));
        const std::string towards = ownAddressTowards(x_.host, family);
        if (auto path = rsp::findInterface(towards, family); path && !towards.empty())
            x_.network.interfaceTowards = path->name;
        return process_->send({{"secret", toHex(secret.value())},
                               {"addresses", ownAddresses(towards, family, false)},
                               {"port", tcpPort(localTcpAddress(here_.listening.get()))},
                               {"group", here_.group},
                               {"interface", ""},
                               {"survey", survey}});
    }

    void fail(const char* part, const Error& error) {
        x_.failure = error.message;
        x_.failurePart = part;
    }

    void measureClock() {
        ClockOffset offset;
        for (int i = 0; i < kClockProbes; ++i) {
            ClockSample sample;
            sample.sentNs = timeOfDayNs();
            const auto answer = process_->query({{"do", "clock"}}, Deadline::inMs(kReplyMs));
            sample.cameBackNs = timeOfDayNs();
            if (!answer || !answer.value().contains("ns") || !answer.value()["ns"].is_number_integer()) return;
            sample.arrivedThereNs = sample.leftThereNs = answer.value()["ns"].get<int64_t>();
            offset.add(sample);
        }
        x_.clock = {true, static_cast<double>(offset.offsetNs()) * 1e-9, static_cast<double>(offset.errorNs()) * 1e-9};
    }

    // One host at a time, because all share this machine's interface.
    bool measureRates() {
        if (here_.deadline.leftNs() < kInspectionMs * kNsPerMs) return true; // many hosts: this one remains unmeasured
        const std::lock_guard lock(here_.rates);
        if (here_.deadline.leftNs() < kInspectionMs * kNsPerMs) return true;
        const auto secret = makeSessionSecret();
        const std::string token = secret ? toHex(secret.value()).substr(0, kRateTokenBytes) : std::string();
        auto own = numericAddress(x_.network.own, 0);
        if (token.empty() || !own) return true;
        auto listening = process_->query(
            {{"do", "listen"}, {"family", own->family()}, {"token", token}, {"ms", kRateMs}}, Deadline::inMs(kReplyMs));
        if (!listening) return fail("rate", listening.error()), false;
        const auto port = static_cast<uint16_t>(realIn(*listening, "port"));
        auto host = numericAddress(x_.network.own, port);
        if (port == 0 || !host) {
            x_.toHost.problem = wordIn(*listening, "problem");
            return true;
        }
        auto rate = measureRate(*host, token, kRateMs);
        if (!rate) { // without a connection, the host's answer would come at the end of its deadline only
            x_.portProblem = rate.error().message;
            return true;
        }
        x_.fromHost = rate.value();
        auto answer = process_->query({{"do", "rate"}}, Deadline::inMs(kReplyMs));
        if (!answer) return fail("rate", answer.error()), false;
        x_.toHost = {realIn(*answer, "bytesPerS"), wordIn(*answer, "problem")};
        return true;
    }

    void inspect() {
        const json order{{"do", "inspect"}, {"displays", inspection_.displays}, {"folder", inspection_.folder}};
        auto answer = process_->query(order, Deadline::inMs(kAllMs));
        if (!answer) return fail("GL and displays", answer.error());
        if (answer->contains("host") && (*answer)["host"].is_object()) x_.machine = hostFactsFrom((*answer)["host"]);
    }

    Here& here_;
    const InspectionPlan& inspection_;
    HostExamined& x_;
    std::unique_ptr<ProbeSockets> sockets_;
    std::unique_ptr<ProbeProcess> process_;
};

Result<void> open(const HostsPlan& plan, Here& here) {
    auto group = numericEndpoint(plan.group);
    if (!group) return group.error();
    here.group = plan.group;
    here.groupAddress = *group;
    const int family = group->family();
    std::string wanted = plan.interface;
    if (wanted.empty()) wanted = ownAddressTowards(plan.hosts.front(), family);
    auto interface = rsp::findInterface(wanted, family);
    if (!interface && plan.interface.empty()) interface = rsp::findInterface("", family);
    if (!interface) return interface.error();
    here.interface = *interface;
    auto listening = listenAnywhere(family);
    if (!listening) return listening.error();
    here.listening = std::move(*listening);
    here.network.headerBytes = family == AF_INET ? kIpv4HeaderBytes : kIpv6HeaderBytes;
    here.network.cardBytes = std::min(here.interface.mtuBytes - here.network.headerBytes, kLargestDatagramBytes);
    return {};
}

// Runs all examinations at once, and ends those that take too long.
void runAll(std::vector<std::unique_ptr<HostExamination>>& examinations, Deadline deadline) {
    std::vector<std::thread> threads;
    std::atomic<size_t> finished = 0;
    for (auto& examination : examinations)
        threads.emplace_back([&finished, &examination] {
            examination->run();
            ++finished;
        });
    while (finished < threads.size() && !deadline.passed()) poll(nullptr, 0, 10);
    if (finished < threads.size())
        for (auto& examination : examinations) examination->abandon();
    for (std::thread& thread : threads) thread.join();
}

} // namespace

Result<HostsSurvey> surveyHosts(const HostsPlan& plan) {
    Here here;
    if (auto r = open(plan, here); !r) return r.error();
    auto sockets = ProbeSockets::open(here.groupAddress, here.interface, 0, true); // for the size of their buffers
    if (!sockets) return sockets.error();
    HostsSurvey survey;
    survey.build = streamBuild();
    survey.here = {muralVersion(), readMachineFacts(here.interface, sockets->bufferBytes()), plan.group,
                   here.network.headerBytes, here.network.cardBytes};
    survey.hosts.resize(plan.hosts.size()); // the examinations hold references to these elements
    std::vector<std::unique_ptr<HostExamination>> examinations;
    for (size_t i = 0; i < plan.hosts.size(); ++i) {
        HostExamined& x = survey.hosts[i];
        x.host = x.network.host = plan.hosts[i];
        x.network.hasStream = false;
        examinations.push_back(std::make_unique<HostExamination>(here, plan.inspections[i], x));
        examinations.back()->start(probeCommand(plan.launchCommand, plan.remoteMural, x.host));
    }
    runAll(examinations, here.deadline);
    return survey;
}

} // namespace mural::cli
