// Starts nodes as the further processes of one mpirun or srun: rank 0 is the head, and the other ranks run
// `mural run`, too. They receive their nodes through PMIx.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nodes/launch/launchers/launcher.hpp"
#include "nodes/launch/launchers/pmix_client.hpp"

namespace mural {

// Names of hosts: "rank1", "rank2", …
std::string pmixHostOf(int rank);

class PmixLauncher : public Launcher {
public:
    // timeoutMs: until all ranks have arrived.
    explicit PmixLauncher(int64_t timeoutMs);
    ~PmixLauncher() override;
    // The first call starts nodes, and returns null pointers for them: only their connections show their ends. Each
    // rank starts its nodes once, so later calls fail.
    std::vector<std::unique_ptr<RunningNode>> start(const std::vector<NodeTask>& tasks) override;
    [[nodiscard]] bool knowsHosts() const override { return false; }

private:
    Result<void> publish(const std::vector<NodeTask>& tasks);

    const int64_t timeoutMs_;
    bool isStarted_ = false;
    std::unique_ptr<launch::PmixClient> client_;
};

// A rank other than 0: starts its nodes and waits for their end. Returns the exit status. timeoutMs: for rank 0.
int runPmixRank(int rank, const NodeBinary& binary, int64_t timeoutMs);

} // namespace mural
