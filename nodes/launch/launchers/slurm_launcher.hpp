// Starts nodes inside a Slurm job: one step runs a starter on each host, for all of its nodes and their restarts. A
// host whose starter has ended gets a step of its own.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/launch/environment.hpp"
#include "nodes/launch/launchers/launcher.hpp"
#include "nodes/launch/launchers/starter/munge_seal.hpp"
#include "nodes/launch/launchers/ssh_launcher.hpp"

namespace mural {

// The job that this process runs in.
struct SlurmJob {
    std::string id;
    std::vector<std::string> hosts; // by the names of Slurm, in the order of the job
};

// Errors: no job; its host list is invalid.
Result<SlurmJob> slurmJobOf(const launch::Environment& environment);

class SlurmLauncher : public Launcher {
public:
    SlurmLauncher(SlurmJob job, NodeBinary binary, StarterVersion version);
    ~SlurmLauncher() override;
    std::vector<std::unique_ptr<RunningNode>> start(const std::vector<NodeTask>& tasks) override;
    std::string whyOver() override;

private:
    std::shared_ptr<launch::StarterLink> startStep(const std::vector<std::string>& hosts, std::string& why) const;
    [[nodiscard]] std::string sealed(const std::string& host, const std::string& lines) const;

    const SlurmJob job_;
    const NodeBinary binary_;
    const StarterVersion version_;
    std::unique_ptr<launch::MungeSeal> munge_;                          // null: not installed
    std::map<std::string, std::shared_ptr<launch::StarterLink>> links_; // by host
};

// The srun command of a step on these hosts. Pure.
std::vector<std::string> srunCommandOf(const std::string& job, const std::vector<std::string>& hosts,
                                       const NodeBinary& binary);
// Returns the hosts that a line of srun reports as lost: "srun: error: wall[1-2]: tasks 0-1: Killed". Pure.
std::vector<std::string> hostsLostIn(std::string_view line);
// Returns the remedy for a failure of srun with these lines, such as "; …". May be empty. Pure.
std::string srunRemedy(const std::string& lines);

} // namespace mural
