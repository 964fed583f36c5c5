#include "tools/mural/network/network_survey.hpp"

#include <algorithm>
#include <cstring>
#include <netinet/in.h>

#include "nodes/launch/environment.hpp"
#include "nodes/session/session_secret.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/network/host_survey.hpp"
#include "tools/mural/network/probe_command.hpp"
#include "transport/rsp/group_text.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kStartMs = 30'000; // for all members together, as for a session's nodes
constexpr size_t kUdpOverIpv4Bytes = 28;
constexpr size_t kUdpOverIpv6Bytes = 48;
constexpr size_t kMaxDatagramBytes = 8972; // as RSP

struct Started {
    std::unique_ptr<ProbeProcess> process;
    std::unique_ptr<HostSurvey> survey;
};

class Surveying {
public:
    explicit Surveying(const NetworkArguments& a) : a_(a) {}

    Result<Survey> run(const std::function<void(const std::string&)>& progress) {
        if (auto r = open(); !r) return r.error();
        const std::vector<std::string> hosts =
            a_.hosts.empty() ? std::vector<std::string>{"this machine"} : splitWords(a_.hosts, ',');
        // Surveys hold pointers to these elements.
        survey_.hosts.resize(hosts.size());
        for (size_t i = 0; i < hosts.size(); ++i) survey_.hosts[i].host = hosts[i];
        for (HostMeasured& h : survey_.hosts) started_.push_back(start(h));
        const Deadline deadline = Deadline::inMs(kStartMs);
        for (size_t i = 0; i < hosts.size(); ++i) {
            if (!started_[i].survey) continue;
            progress(hosts[i]);
            surveyHost(started_[i], survey_.hosts[i], deadline);
        }
        // Checks the first hosts again, because switches forget multicast groups after some time.
        for (size_t i = 0; i + 1 < hosts.size(); ++i) {
            if (started_[i].survey && survey_.hosts[i].failure.empty())
                note(started_[i].survey->probeAgain(), survey_.hosts[i]);
        }
        return std::move(survey_);
    }

private:
    Result<void> open() {
        auto group = numericEndpoint(a_.group);
        if (!group) return group.error();
        family_ = group->family();
        auto rate = rsp::parseRate(a_.rate);
        if (!rate) return rate.error();
        const auto secret = makeSessionSecret(), number = makeSessionSecret();
        if (!secret) return secret.error();
        if (!number) return number.error();
        secret_ = secret.value();
        std::memcpy(&number_, number.value().data(), sizeof number_);
        // Default: the interface that leads to the first host.
        std::string wanted = a_.interface;
        if (wanted.empty() && !a_.hosts.empty()) wanted = ownAddressTowards(splitWords(a_.hosts, ',').front(), family_);
        auto interface = rsp::findInterface(wanted, group->family());
        if (!interface && a_.interface.empty()) interface = rsp::findInterface("", group->family());
        if (!interface) return interface.error();
        interface_ = *interface;
        auto sockets = ProbeSockets::open(*group, interface_, number_, true);
        if (!sockets) return sockets.error();
        sockets_.emplace(std::move(*sockets));
        plan_.group.group = a_.group;
        plan_.group.interface = interface_.name;
        plan_.group.secret = secret_;
        plan_.group.seal = rsp::bestEncryption();
        plan_.group.bytesPerS = *rate;
        plan_.headerBytes = group->family() == AF_INET ? kUdpOverIpv4Bytes : kUdpOverIpv6Bytes;
        plan_.cardBytes = std::min(interface_.mtuBytes - plan_.headerBytes, kMaxDatagramBytes);
        plan_.seconds = a_.seconds;
        survey_.here = {muralVersion(), readMachineFacts(interface_, sockets_->bufferBytes()), a_.group,
                        plan_.headerBytes, plan_.cardBytes};
        // Members test their connection to this machine here.
        auto listening = rsp::Group::host(plan_.group);
        if (!listening) return listening.error();
        listening_ = std::move(*listening);
        return {};
    }

    Started start(HostMeasured& h) {
        auto process =
            ProbeProcess::start(a_.hosts.empty() ? std::vector<std::string>{launch::ownBinary(), "network-member"}
                                                 : probeCommand(a_.launchCommand, a_.remoteMural, h.host));
        if (!process) {
            h.failure = process.error().message;
            return {};
        }
        const SocketAddress* ownEnd = interface_.address(family_);
        const std::string towards =
            a_.hosts.empty() ? (ownEnd ? numericText(*ownEnd) : "") : ownAddressTowards(h.host, family_);
        if (auto path = rsp::findInterface(towards, family_); path && !towards.empty()) h.interfaceTowards = path->name;
        auto port = splitHostPort(listening_->controlAddress());
        const nlohmann::json order{{"secret", toHex(secret_)},
                                   {"addresses", ownAddresses(towards, family_, a_.hosts.empty())},
                                   {"port", port ? port->port : 0},
                                   {"group", a_.group},
                                   {"interface", a_.hosts.empty() ? interface_.name : ""},
                                   {"survey", number_}};
        if (auto r = (*process)->send(order); !r) {
            h.failure = r.error().message;
            return {};
        }
        Started s;
        s.process = std::move(*process);
        s.survey = std::make_unique<HostSurvey>(plan_, *sockets_, *s.process, h);
        return s;
    }

    static void surveyHost(Started& s, HostMeasured& h, Deadline deadline) {
        note(s.survey->greet(deadline), h);
        if (h.failure.empty() && !h.reached.empty()) note(s.survey->measure(), h);
    }
    static void note(const Result<void>& r, HostMeasured& h) {
        if (!r) h.failure = r.error().message;
    }

    const NetworkArguments& a_;
    Survey survey_;
    SurveyPlan plan_;
    SessionSecret secret_{};
    uint64_t number_ = 0; // random number of this survey, sent in clear
    int family_ = 0;      // of the group's address
    rsp::NetworkInterface interface_;
    std::optional<ProbeSockets> sockets_;
    std::unique_ptr<rsp::Group> listening_;
    std::vector<Started> started_;
};

} // namespace

Result<Survey> surveyNetwork(const NetworkArguments& arguments,
                             const std::function<void(const std::string& host)>& progress) {
    return Surveying(arguments).run(progress);
}

} // namespace mural::cli
