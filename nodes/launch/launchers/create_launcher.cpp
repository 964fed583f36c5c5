#include "nodes/launch/launchers/create_launcher.hpp"

#include <utility>

#include "nodes/launch/launchers/command_launcher.hpp"
#include "nodes/launch/launchers/pmix_launcher.hpp"
#include "nodes/launch/launchers/shell_words.hpp"
#include "nodes/launch/launchers/slurm_launcher.hpp"

namespace mural {
namespace {

// Waiting nodes (@NAME) are called with `mural call`, the others start by another launcher.
class WaitingNodesLauncher : public Launcher {
public:
    WaitingNodesLauncher(std::unique_ptr<Launcher> waiting, std::unique_ptr<Launcher> others)
        : waiting_(std::move(waiting)), others_(std::move(others)) {}

    std::vector<std::unique_ptr<RunningNode>> start(const std::vector<NodeTask>& tasks) override {
        std::vector<NodeTask> called, started;
        for (const NodeTask& task : tasks) (isWaiting(task) ? called : started).push_back(task);
        auto fromCalls = waiting_->start(called);
        auto fromStarts = others_->start(started);
        std::vector<std::unique_ptr<RunningNode>> nodes;
        auto call = fromCalls.begin(), start = fromStarts.begin();
        for (const NodeTask& task : tasks) nodes.push_back(std::move(isWaiting(task) ? *call++ : *start++));
        return nodes;
    }
    std::string whyOver() override { return others_->whyOver(); }
    [[nodiscard]] bool knowsHosts() const override { return others_->knowsHosts(); }

private:
    static bool isWaiting(const NodeTask& task) { return task.host.starts_with("@"); }

    const std::unique_ptr<Launcher> waiting_, others_;
};

Result<std::unique_ptr<Launcher>> launcherOf(const LaunchSettings& settings, const launch::Environment& environment) {
    if (settings.how == "ssh")
        return std::unique_ptr<Launcher>(std::make_unique<SshLauncher>(settings.binary, settings.version));
    if (settings.how == "pmix")
        return std::unique_ptr<Launcher>(std::make_unique<PmixLauncher>(settings.startTimeoutMs));
    if (settings.how != "slurm")
        return std::unique_ptr<Launcher>(
            std::make_unique<CommandLauncher>(launch::wordsOf(settings.how), settings.binary));
    auto job = slurmJobOf(environment);
    if (!job) return job.error();
    return std::unique_ptr<Launcher>(
        std::make_unique<SlurmLauncher>(std::move(*job), settings.binary, settings.version));
}

} // namespace

Result<std::unique_ptr<Launcher>> createLauncher(const LaunchSettings& settings,
                                                 const launch::Environment& environment) {
    auto main = launcherOf(settings, environment);
    if (!main || settings.secretFile.empty()) return main;
    auto waiting = std::make_unique<CommandLauncher>(
        std::vector<std::string>{settings.ownMural, "call", "--secret", settings.secretFile}, settings.binary);
    return std::unique_ptr<Launcher>(std::make_unique<WaitingNodesLauncher>(std::move(waiting), std::move(*main)));
}

} // namespace mural
