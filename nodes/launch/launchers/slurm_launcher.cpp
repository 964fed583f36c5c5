#include "nodes/launch/launchers/slurm_launcher.hpp"

#include <algorithm>
#include <csignal>

#include "common/log/log.hpp"
#include "nodes/launch/launchers/host_list.hpp"
#include "nodes/launch/launchers/shell_words.hpp"
#include "nodes/launch/launchers/starter/starter_link.hpp"
#include "nodes/launch/launchers/starter/starter_protocol.hpp"

namespace mural {
namespace {

// Options of the job that srun reads from the environment, and that would change the step.
constexpr const char* kJobOptions[] = {
    "SLURM_NTASKS",        "SLURM_NPROCS",        "SLURM_NTASKS_PER_NODE", "SLURM_NNODES",
    "SLURM_JOB_NUM_NODES", "SLURM_DISTRIBUTION",  "SLURM_CPU_BIND",        "SLURM_CPU_BIND_TYPE",
    "SLURM_CPU_BIND_LIST", "SLURM_CPUS_PER_TASK", "SLURM_TRES_PER_TASK",   "SLURM_STEP_ID",
    "SLURM_WAIT",          "SLURM_MPI_TYPE",      "SLURM_LABELIO",         "SLURM_UNBUFFEREDIO"};

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

} // namespace

Result<SlurmJob> slurmJobOf(const launch::Environment& environment) {
    SlurmJob job;
    job.id = environment.get("SLURM_JOB_ID").value_or("");
    if (job.id.empty())
        return Error{
            "no Slurm job: SLURM_JOB_ID is not set; start it inside of salloc or sbatch, or add --slurm \"-N4\""};
    const std::string list = environment.get("SLURM_JOB_NODELIST").value_or("");
    if (list.empty()) return Error{"Slurm job " + job.id + " has no host list (SLURM_JOB_NODELIST)"};
    auto hosts = launch::expandHostList(list);
    if (!hosts) return Error{"SLURM_JOB_NODELIST: " + hosts.error().message};
    job.hosts = std::move(*hosts);
    return job;
}

// The other tasks continue after the end of a task (--wait=0, --kill-on-bad-exit=0) and after the loss of a host
// (--no-kill). The job's other steps may use the same processors (--overlap).
std::vector<std::string> srunCommandOf(const std::string& job, const std::vector<std::string>& hosts,
                                       const NodeBinary& binary) {
    const std::string count = std::to_string(hosts.size());
    std::vector<std::string> command{"srun",
                                     "--jobid=" + job,
                                     "--job-name=mural",
                                     "--nodelist=" + launch::joined(hosts, ","),
                                     "--nodes=" + count,
                                     "--ntasks=" + count,
                                     "--ntasks-per-node=1",
                                     "--mpi=none",
                                     "--cpu-bind=none",
                                     "--overlap",
                                     "--input=all",
                                     "--wait=0",
                                     "--kill-on-bad-exit=0",
                                     "--no-kill"};
    for (const std::string& word : starterCommandOf(binary)) command.push_back(word);
    return command;
}

std::vector<std::string> hostsLostIn(std::string_view line) {
    constexpr std::string_view kError = "srun: error: ";
    if (!line.starts_with(kError)) return {};
    line.remove_prefix(kError.size());
    constexpr std::string_view kFailure = "Node failure on ";
    if (line.starts_with(kFailure)) {
        line.remove_prefix(kFailure.size());
    } else {
        const size_t colon = line.find(": task");
        if (colon == std::string_view::npos) return {};
        line = line.substr(0, colon);
    }
    while (!line.empty() && line.back() == ' ') line.remove_suffix(1);
    auto hosts = launch::expandHostList(line);
    return hosts ? std::move(*hosts) : std::vector<std::string>();
}

std::string srunRemedy(const std::string& lines) {
    if (has(lines, "step creation temporarily disabled") || has(lines, "Requested nodes are busy"))
        return "; another step holds the job's resources: start that one with --overlap";
    if (has(lines, "Memory required") || has(lines, "memory"))
        return "; another step holds the job's memory: start that one with --mem=0 --overlap";
    if (has(lines, "Requested node configuration is not available") || has(lines, "node count"))
        return "; request the hosts of the wall for the job (-N)";
    if (has(lines, "Unable to confirm allocation") || has(lines, "Invalid job id") || has(lines, "expired"))
        return "; the job has ended: request a new one";
    if (has(lines, "Invalid MPI type") || has(lines, "Authentication") || has(lines, "munge"))
        return "; check the installation of Slurm with srun hostname";
    if (has(lines, "execve") || has(lines, "No such file"))
        return "; install mural on the hosts, or give its path with --remote-mural";
    return "";
}

SlurmLauncher::SlurmLauncher(SlurmJob job, NodeBinary binary, StarterVersion version)
    : job_(std::move(job)), binary_(std::move(binary)), version_(std::move(version)) {
    auto munge = launch::MungeSeal::open();
    if (munge) munge_ = std::move(*munge);
    if (!munge) log::debug(log::Topic::Launch, "the secrets of the nodes are not sealed: ", munge.error().message);
}

SlurmLauncher::~SlurmLauncher() = default;

std::shared_ptr<launch::StarterLink> SlurmLauncher::startStep(const std::vector<std::string>& hosts,
                                                              std::string& why) const {
    launch::Environment environment = launch::Environment::current();
    launch::removeCapture(environment);
    for (const char* const name : kJobOptions) environment.unset(name);
    launch::StarterCommand command;
    command.arguments = srunCommandOf(job_.id, hosts, binary_);
    command.environment = environment.entries();
    command.name = "srun on " + launch::joined(hosts, ",");
    command.version = version_.version;
    command.build = version_.build;
    command.signalWhenWeDie = SIGTERM; // srun then ends its step
    command.lostHosts = hostsLostIn;
    command.addRemedy = srunRemedy;
    auto started = launch::StarterLink::start(std::move(command));
    if (!started) why = started.error().message;
    return started ? *started : nullptr;
}

// srun authenticates its connections to the hosts, but does not encrypt them.
std::string SlurmLauncher::sealed(const std::string& host, const std::string& lines) const {
    if (!munge_) return lines;
    const auto credential = munge_->seal(lines + "\n");
    if (!credential) {
        log::debug(log::Topic::Launch, "the secrets of the nodes are not sealed: ", credential.error().message);
        return lines;
    }
    launch::StarterRequest request;
    request.kind = launch::StarterRequest::Kind::Sealed;
    request.host = host;
    request.credential = credential.value();
    return lineOf(request);
}

std::vector<std::unique_ptr<RunningNode>> SlurmLauncher::start(const std::vector<NodeTask>& tasks) {
    std::vector<std::string> fresh; // hosts without a starter, each once
    for (const NodeTask& task : tasks) {
        const auto link = links_.find(task.host);
        const bool isRunning = link != links_.end() && link->second && !link->second->isGone(task.host);
        const bool isKnown = std::ranges::find(job_.hosts, task.host) != job_.hosts.end();
        if (!isRunning && isKnown && std::ranges::find(fresh, task.host) == fresh.end()) fresh.push_back(task.host);
    }
    std::string why;
    if (!fresh.empty()) {
        const auto step = startStep(fresh, why);
        for (const std::string& host : fresh) links_[host] = step;
    }
    std::vector<std::unique_ptr<RunningNode>> nodes;
    std::map<std::string, std::string> lines; // by host
    for (const NodeTask& task : tasks) {
        const auto link = links_.find(task.host);
        if (link == links_.end() || !link->second) {
            nodes.push_back(std::make_unique<AbsentNode>(
                link != links_.end() ? why
                                     : task.host + " is not in Slurm job " + job_.id + ", which has " +
                                           launch::joined(job_.hosts, ",") + "; request it with -w"));
            continue;
        }
        auto prepared = link->second->prepare(task, task.host);
        std::string& text = lines[task.host];
        text += (text.empty() ? "" : "\n") + prepared.line;
        nodes.push_back(std::move(prepared.node));
    }
    for (const auto& [host, text] : lines) links_[host]->send(sealed(host, text));
    return nodes;
}

std::string SlurmLauncher::whyOver() {
    for (const auto& [host, link] : links_) {
        if (!link || !link->ended()) continue;
        const std::string lines = link->recentOutput();
        const bool isCancelled = has(lines, "CANCELLED") && has(lines, "JOB " + job_.id); // not only a step
        if (isCancelled || has(lines, "Force Terminated job") || has(lines, "DUE TO TIME LIMIT"))
            return "Slurm has ended job " + job_.id + ": " + lines;
    }
    return {};
}

} // namespace mural
