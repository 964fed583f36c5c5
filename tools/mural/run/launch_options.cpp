// Options of `mural run` for the hosts of the nodes and the way to start nodes there, and the choice of --launch auto.
#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <unistd.h>

#include "nodes/head/planning/preset_plan.hpp"
#include "nodes/launch/launchers/host_list.hpp"
#include "nodes/launch/launchers/pmix_launcher.hpp"
#include "nodes/launch/launchers/shell_words.hpp"
#include "nodes/launch/launchers/slurm_launcher.hpp"
#include "tools/mural/run/option_values.hpp"
#include "tools/mural/run/run_option_readers.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kMaxStartSeconds = 86'400;

Result<void> readHosts(const char* option, const OptionText& text, std::vector<std::string>& hosts) {
    if (!text) return {};
    hosts = listOf(*text);
    if (!std::ranges::all_of(hosts, launch::isHostName))
        return badValue(option, *text, "must be host names separated by commas, such as wall1,wall2");
    // Rejects numbers as host names, because connecting to them would only time out.
    const bool counts = std::ranges::any_of(
        hosts, [](const std::string& h) { return h.find_first_not_of("0123456789") == std::string::npos; });
    if (counts)
        return badValue(
            option, *text,
            "must be host names, such as wall1,wall2; --local-nodes sets the number of nodes on this machine");
    return {};
}

// Repeats each host for its nodes.
Result<void> readHostFile(const std::string& file, int perHost, std::vector<std::string>& hosts) {
    std::ifstream in(file);
    if (!in) return Error{fmt::format("--hostfile {}: it cannot be read; give a file with one host per line", file)};
    std::ostringstream text;
    text << in.rdbuf();
    const auto entries = launch::hostsOfFile(text.str(), file);
    if (!entries) return entries.error();
    for (const launch::HostEntry& entry : entries.value()) {
        const int nodes = perHost > 0 ? perHost : std::max(entry.nodes, 1);
        if (hosts.size() + static_cast<size_t>(nodes) > static_cast<size_t>(kMaxNodes))
            return Error{fmt::format("--hostfile {}: more than {} render nodes", file, kMaxNodes)};
        hosts.insert(hosts.end(), static_cast<size_t>(nodes), entry.name);
    }
    return {};
}

std::vector<std::string> repeated(const std::vector<std::string>& hosts, int perHost) {
    std::vector<std::string> all;
    for (const std::string& host : hosts) all.insert(all.end(), static_cast<size_t>(std::max(perHost, 1)), host);
    return all;
}

bool isThisMachine(const std::string& host, const launch::Environment& environment) {
    char name[256] = "";
    gethostname(name, sizeof(name) - 1);
    return host == name || host == environment.get("SLURMD_NODENAME").value_or("");
}

// The number of render nodes that the options can use; tiles and passes have been read.
size_t mostNodes(const RunArguments& a, const SessionConfig& c) {
    if (!a.tiles && !a.tileQueue) return static_cast<size_t>(kMaxNodes);
    if (sharesParts(c)) return static_cast<size_t>(kMaxNodes);
    return static_cast<size_t>(c.columns) * static_cast<size_t>(c.rows) * passesOf(c.passes).size() *
           static_cast<size_t>(c.passes.ranges);
}

// Takes the hosts of the Slurm job as nodes. Returns the reason.
Result<std::string> takeJob(const RunArguments& a, const launch::Environment& environment, int perHost,
                            SessionConfig& c) {
    auto job = slurmJobOf(environment);
    if (!job) return job.error();
    c.hosts = repeated(job->hosts, perHost);
    c.hosts.resize(std::min({c.hosts.size(), mostNodes(a, c), static_cast<size_t>(kMaxNodes)}));
    return fmt::format("Slurm job {} has the hosts {}", job->id, launch::joined(job->hosts, ","));
}

bool isWithin(const std::vector<std::string>& hosts, const std::vector<std::string>& all) {
    return std::ranges::all_of(hosts, [&](const std::string& h) { return std::ranges::find(all, h) != all.end(); });
}

// Takes the other processes of the same mpirun or srun as nodes. Returns the reason.
Result<std::string> takeRanks(const RunArguments& a, const launch::PmixPlace& place, int perHost, SessionConfig& c) {
    if (place.rank < 0)
        return Error{
            "no PMIx: PMIX_RANK is not set; start it with mpirun -n 5 mural run, or srun --mpi=pmix -n5 mural run"};
    if (place.size < 2)
        return Error{"PMIx has started one process, but the first is the head; start as many more as there are nodes"};
    std::vector<std::string> ranks;
    for (int rank = 1; rank < place.size; ++rank) ranks.push_back(pmixHostOf(rank));
    c.hosts = repeated(ranks, perHost);
    c.hosts.resize(std::min({c.hosts.size(), mostNodes(a, c), static_cast<size_t>(kMaxNodes)}));
    return fmt::format("this is rank {} of {} processes", place.rank, place.size);
}

// --launch auto: selects by the hosts, the batch job and PMIx.
Result<std::string> chooseLauncher(const RunArguments& a, const launch::Environment& environment, int perHost,
                                   SessionConfig& c) {
    const bool areGiven = !c.hosts.empty() || a.localNodes || a.config || !a.startsNodes;
    const launch::PmixPlace place = launch::pmixPlaceOf(environment);
    if (!areGiven && place.rank >= 0 && place.size > 1) {
        c.launchCommand = "pmix";
        return takeRanks(a, place, perHost, c);
    }
    auto job = slurmJobOf(environment);
    if (!areGiven && job && !(job->hosts.size() == 1 && isThisMachine(job->hosts.front(), environment))) {
        c.launchCommand = "slurm";
        return takeJob(a, environment, perHost, c);
    }
    if (job && !c.hosts.empty() && isWithin(c.hosts, job->hosts) && isWithin(c.spareHosts, job->hosts)) {
        c.launchCommand = "slurm";
        return fmt::format("all hosts are in Slurm job {}", job->id);
    }
    c.launchCommand = "ssh";
    if (c.hosts.empty() && job && a.config)
        return std::string("the file names the hosts; --launch slurm selects the nodes of the job");
    if (c.hosts.empty()) return std::string();
    return job ? fmt::format("not all hosts are in Slurm job {}, which has {}", job->id,
                             launch::joined(job->hosts, ","))
               : std::string("the nodes have hosts");
}

} // namespace

Result<std::string> readLaunch(const RunArguments& a, const launch::Environment& environment, SessionConfig& c) {
    int perHost = 0;
    if (auto r = readCount("--per-host", a.perHost, kMaxNodes, perHost); !r) return r.error();
    if (a.nodes && a.hostFile) return Error{"--nodes and --hostfile both name the hosts; omit one of them"};
    if (a.config && a.hostFile) return Error{"--hostfile and --config both name the hosts; omit one of them"};
    if (auto r = readHosts("--nodes", a.nodes, c.hosts); !r) return r.error();
    if (a.nodes) c.hosts = repeated(c.hosts, perHost);
    if (a.hostFile)
        if (auto r = readHostFile(*a.hostFile, perHost, c.hosts); !r) return r.error();
    if (auto r = readHosts("--spare-nodes", a.spareNodes, c.spareHosts); !r) return r.error();
    int64_t seconds = c.startTimeoutMs / 1000;
    if (auto r = readNumber("--start-timeout", a.startTimeout, 1, kMaxStartSeconds, seconds); !r) return r.error();
    c.startTimeoutMs = seconds * 1000;
    if (a.launchSecret && a.launchSecret->empty())
        return badValue("--secret", "", "must be a file with the secret of waiting nodes");
    c.launchSecret = a.launchSecret.value_or("");
    const std::string how = a.launch.value_or("auto");
    if (launch::wordsOf(how).empty())
        return badValue("--launch", how, "must be auto, local, ssh, slurm, pmix, or a command such as \"ssh -p 2222\"");
    std::string why = "--launch";
    if (how == "auto") {
        auto chosen = chooseLauncher(a, environment, perHost, c);
        if (!chosen) return chosen.error();
        why = std::move(*chosen);
    } else {
        c.launchCommand = how;
    }
    if (how == "slurm") {
        if (c.hosts.empty() && !a.config && a.startsNodes) {
            auto taken = takeJob(a, environment, perHost, c);
            if (!taken) return taken.error();
        }
        if (auto job = slurmJobOf(environment); !job) return Error{"--launch slurm: " + job.error().message};
    }
    if (how == "pmix") {
        if (!c.hosts.empty() || a.config)
            return Error{"--launch pmix: the hosts are those of mpirun or srun; omit --nodes, --hostfile and --config"};
        auto taken = takeRanks(a, launch::pmixPlaceOf(environment), perHost, c);
        if (!taken) return Error{"--launch pmix: " + taken.error().message};
    }
    if (how == "local") {
        c.localNodes = static_cast<int>(c.hosts.size());
        c.hosts.clear();
        c.launchCommand = "ssh";
        return std::string("nodes start on this machine (local): --launch");
    }
    const bool isCommand = c.launchCommand != "ssh" && c.launchCommand != "slurm" && c.launchCommand != "pmix";
    const auto waiting = std::ranges::find_if(c.hosts, [](const std::string& h) { return h.starts_with("@"); });
    if (waiting != c.hosts.end() && c.launchSecret.empty() && !isCommand && a.startsNodes)
        return Error{
            fmt::format("{} is a waiting node (mural node --wait); add --secret FILE with its secret", *waiting)};
    if (perHost > 0 && c.hosts.empty())
        return Error{
            "--per-host needs hosts: --nodes, --hostfile, or a batch job; --local-nodes sets the number of nodes "
            "on this machine"};
    if (why.empty()) return std::string();
    const bool areWaiting =
        !isCommand && std::ranges::all_of(c.hosts, [](const auto& h) { return h.starts_with("@"); });
    if (areWaiting && !c.hosts.empty()) return std::string("nodes start by mural call: all of them wait for heads");
    return fmt::format("nodes start by {}: {}", c.launchCommand, why);
}

} // namespace mural::cli
