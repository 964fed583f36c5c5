#include "tools/mural/hosts/hosts_doctor.hpp"

#include <CLI/App.hpp>
#include <algorithm>
#include <csignal>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/program_check.hpp"
#include "tools/mural/doctor/check_report.hpp"
#include "tools/mural/hosts/fix_script.hpp"
#include "tools/mural/hosts/hosts_table.hpp"
#include "tools/mural/network/network_arguments.hpp"
#include "tools/mural/network/network_verdict.hpp"
#include "tools/mural/network/probe_command.hpp"

namespace mural::cli {

namespace {

using nlohmann::json;
using Expected = std::map<std::string, std::vector<ExpectedScreen>>;

int complainAboutHosts(const std::string& text) {
    fmt::print(stderr, "mural doctor --nodes: {}\n", text);
    return launch::kExitUsage;
}

HostsPlan planOf(const HostsArguments& a, const NetworkArguments& network, const Expected& expected) {
    HostsPlan plan{
        splitWords(a.hosts, ','), network.launchCommand, network.remoteMural, network.group, network.interface, {}};
    for (const std::string& host : plan.hosts) {
        InspectionPlan inspection{{}, a.recordings};
        if (const auto screens = expected.find(host); screens != expected.end())
            for (const ExpectedScreen& e : screens->second)
                if (!e.display.empty() &&
                    std::ranges::find(inspection.displays, e.display) == inspection.displays.end())
                    inspection.displays.push_back(e.display);
        plan.inspections.push_back(std::move(inspection));
    }
    return plan;
}

json jsonOfHosts(const HostsSurvey& survey, const std::vector<HostChecks>& hosts, Health worst) {
    json list = json::array();
    for (size_t i = 0; i < hosts.size(); ++i) {
        const HostExamined& x = survey.hosts[i];
        list.push_back(
            {{"host", x.host},
             {"failure", x.failure},
             {"version", x.network.version},
             {"checks", toJson(hosts[i].checks)},
             {"machine", toJson(x.machine)},
             {"network", toJson(x.network.facts)},
             {"clock", {{"measured", x.clock.measured}, {"offsetS", x.clock.offsetS}, {"errorS", x.clock.errorS}}},
             {"rate", {{"toBytesPerS", x.toHost.bytesPerS}, {"fromBytesPerS", x.fromHost.bytesPerS}}}});
    }
    return {{"status", worst == Health::Bad    ? "bad"
                       : worst == Health::Warn ? "warn"
                                               : "ok"},
            {"machine", toJson(survey.here.facts)},
            {"checks", toJson(judgeHere(survey.here))},
            {"hosts", list}};
}

} // namespace

CLI::Option* describeHostsDoctor(CLI::App& doctor, HostsArguments& a) {
    CLI::Option* nodes =
        doctor.add_option("--nodes", a.hosts, "examine these hosts, all at once, with a process on each");
    nodes->type_name("H1,H2");
    doctor
        .add_option("--config", a.configFile, "with --nodes: compare displays and sizes with this configuration file")
        ->type_name("FILE")
        ->needs(nodes);
    doctor
        .add_option("--recordings", a.recordings, "with --nodes: folder for recordings on the hosts (the home folder)")
        ->type_name("DIR")
        ->needs(nodes);
    doctor.add_flag("--all", a.all, "with --nodes: also checks without findings")->needs(nodes);
    doctor
        .add_flag("--fix", a.fix, "with --nodes: print the commands of all findings as a script, without running them")
        ->needs(nodes)
        ->excludes("--json");
    return nodes;
}

int hostsDoctorCommand(const HostsArguments& arguments, const NetworkArguments& network, bool asJson) {
    launch::rememberSignals();
    std::signal(SIGPIPE, SIG_IGN); // a host's process may end at any time
    Expected expected;
    if (!arguments.configFile.empty()) {
        auto read = expectedScreens(arguments.configFile);
        if (!read) return complainAboutHosts(read.error().message);
        expected = std::move(read.value());
    }
    const HostsPlan plan = planOf(arguments, network, expected);
    if (plan.hosts.empty()) return complainAboutHosts("--nodes requires names of hosts, such as wall1,wall2");
    const auto survey = surveyHosts(plan);
    if (!survey) return complainAboutHosts(survey.error().message);
    const std::vector<HostChecks> hosts = judgeHosts(survey.value(), expected);
    const Health worst = worstOf(hosts);
    if (asJson) {
        fmt::print("{}\n", jsonText(jsonOfHosts(survey.value(), hosts, worst), 2));
    } else if (arguments.fix) {
        fmt::print("{}", fixScriptOf(hosts, network.launchCommand));
    } else {
        fmt::print("{}{}", tableOf(hosts, arguments.all), findingsOf(hosts));
        fmt::print("{}\n", worst == Health::Ok ? "All hosts are ready for Mural."
                           : worst == Health::Warn
                               ? "All hosts can be used; see the lines that begin with \"warn\"."
                               : "Some hosts cannot be used yet: fix the lines that begin with \"bad\".");
    }
    return worst == Health::Ok ? 0 : worst == Health::Warn ? 1 : 2;
}

} // namespace mural::cli
