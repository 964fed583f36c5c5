// Starts nodes with ssh: one connection per host runs a starter, for all nodes of the host and for their restarts.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "nodes/launch/launchers/launcher.hpp"

namespace mural {

namespace launch {
class StarterLink;
}

// Identifies this build to starters.
struct StarterVersion {
    std::string version; // of mural
    std::string build;   // of the stream format
};

// Each host runs a login shell that executes `mural starter`. Hosts must accept a login without a password.
class SshLauncher : public Launcher {
public:
    SshLauncher(NodeBinary binary, StarterVersion version);
    ~SshLauncher() override;
    std::vector<std::unique_ptr<RunningNode>> start(const std::vector<NodeTask>& tasks) override;

private:
    std::shared_ptr<launch::StarterLink> linkTo(const std::string& host, std::string& why);

    const NodeBinary binary_;
    const StarterVersion version_;
    std::map<std::string, std::shared_ptr<launch::StarterLink>> links_; // by host
};

// The ssh command that runs a starter on a host. Pure.
std::vector<std::string> sshCommandOf(const std::string& host, const NodeBinary& binary);
// The command of a starter, without quotes. Pure.
std::vector<std::string> starterCommandOf(const NodeBinary& binary);

} // namespace mural
