#include "tools/mural/daemon/daemon_commands.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <optional>
#include <unistd.h>

#include <fmt/format.h>

#include "common/log/log.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/program_check.hpp"
#include "nodes/daemon/daemon_client.hpp"
#include "nodes/daemon/node_daemon.hpp"
#include "tools/mural/commands.hpp"
#include "tools/mural/end_signals.hpp"
#include "transport/discovery/announcing.hpp"
#include "transport/discovery/node_id.hpp"
#include "transport/rsp/group_text.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::cli {

namespace {

DiscoveryOptions discoveryOf(const std::string& text) {
    return {text == "auto" || text == "beacon", text == "auto" || text == "avahi", {}};
}

int failed(const char* command, const std::string& why, int status = 1) {
    fmt::print(stderr, "mural {}: {}\n", command, why);
    return status;
}

std::string machineName() {
    std::array<char, 256> name{};
    if (gethostname(name.data(), name.size() - 1) != 0 || name[0] == 0) return "node";
    return std::string(name.data()).substr(0, kMaxAnnouncedText);
}

bool announceable(const std::string& name) {
    return !name.empty() && name.size() <= kMaxAnnouncedText &&
           std::ranges::all_of(name, [](char c) { return c > ' ' && c <= '~' && c != '@' && c != ','; });
}

} // namespace

void describeWait(CLI::App& node, WaitArguments& a) {
    CLI::Option* wait = node.add_flag("--wait", a.wait,
                                      "daemon: wait for heads that have the secret, and draw for one after the other");
    node.add_option("--secret", a.secretFile, "with --wait: file with the secret, at least 16 bytes; -: standard input")
        ->type_name("FILE")
        ->needs(wait);
    node.add_option("--listen", a.listen, "with --wait: address and port to listen on (all addresses, port 4279)")
        ->type_name("[ADDRESS]:PORT")
        ->needs(wait);
    node.add_option("--name", a.name, "with --wait: name in announcements (the host name)")->needs(wait);
    node.add_option("--discovery", a.discovery, "with --wait: announce this node by beacon, avahi, auto (both) or off")
        ->check(CLI::IsMember({"auto", "beacon", "avahi", "off"}))
        ->needs(wait);
}

int waitCommand(const WaitArguments& a) {
    if (a.secretFile.empty())
        return failed("node", "--wait requires --secret FILE, which authenticates heads", launch::kExitUsage);
    const std::string name = a.name.empty() ? machineName() : a.name;
    if (!announceable(name))
        return failed(
            "node",
            fmt::format("--name \"{}\": must be 1 to {} printable ASCII characters without space, comma and @", name,
                        kMaxAnnouncedText),
            launch::kExitUsage);
    auto secret = rsp::readSecret(a.secretFile);
    if (!secret) return failed("node", secret.error().message, launch::kExitUsage);
    auto signals = endSignals();
    if (!signals) return failed("node", signals.error().message);
    std::signal(SIGPIPE, SIG_IGN);
    auto node = NodeDaemon::open({a.listen, *secret, launch::ownBinary()});
    if (!node) return failed("node", node.error().message);
    std::unique_ptr<Announcing> announcing;
    if (a.discovery != "off") {
        auto id = nodeId();
        if (!id) return failed("node", id.error().message + ", or add --discovery off");
        auto started = Announcing::start({AnnouncementKind::Here, (*node)->port(), *id, name, muralVersion()},
                                         discoveryOf(a.discovery));
        if (!started) return failed("node", started.error().message);
        announcing = std::move(*started);
    }
    log::info(log::Topic::Daemon, name, " waits for heads on port ", (*node)->port(),
              announcing ? "; mural discover finds it" : "");
    const auto r = (*node)->serve(signals->get());
    announcing.reset();
    return r ? 0 : failed("node", r.error().message);
}

void describeCall(CLI::App& call, CallArguments& a) {
    call.add_option("--secret", a.secretFile, "file with the secret of the nodes")->type_name("FILE");
    call.add_option("--discovery", a.discovery, "method to find @NAME: beacon, avahi, auto (both)")
        ->check(CLI::IsMember({"auto", "beacon", "avahi"}));
    call.add_option("--seconds", a.seconds, "time limit to find @NAME (5)")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.1, 600.0));
    call.prefix_command();
}

namespace {

// Resolves HOST, HOST:PORT, or @NAME: a node announced by this name or UUID.
Result<DaemonClient> placeOf(const std::string& host, const CallArguments& a) {
    DaemonClient call;
    if (!host.starts_with("@")) {
        const auto colons = std::ranges::count(host, ':');
        if (colons != 1 && !host.starts_with("[")) {
            call.addresses = {host};
            return call;
        }
        auto where = splitHostPort(host);
        if (!where) return where.error();
        call.addresses = {where->host};
        call.port = where->port;
        return call;
    }
    const std::string name = host.substr(1);
    const auto isIt = [&](const FoundNode& n) { return n.name == name || uuidText(n.uuid) == name; };
    const Discovered d =
        discoverNodes(discoveryOf(a.discovery), Deadline::inMs(static_cast<int64_t>(a.seconds * 1000)),
                      [&](const std::vector<FoundNode>& nodes) { return std::ranges::any_of(nodes, isIt); });
    const auto found = std::ranges::find_if(d.nodes, isIt);
    if (found == d.nodes.end())
        return Error{"no node has the name " + name + "; mural discover lists the nodes of this network"};
    if (std::ranges::count_if(d.nodes, isIt) > 1)
        return Error{"several nodes have the name " + name + "; use @UUID with the UUID that mural discover prints"};
    call.addresses = found->addresses;
    call.port = found->port;
    return call;
}

} // namespace

int callCommand(const CallArguments& a) {
    std::signal(SIGPIPE, SIG_IGN);
    if (a.command.size() < 3)
        return failed(
            "call",
            "HOST, the path of mural on it, and arguments are required; mural run adds these to its --launch command",
            launch::kExitUsage);
    if (a.secretFile.empty())
        return failed("call", "--secret FILE is required, because nodes accept only authenticated heads",
                      launch::kExitUsage);
    // Standard input belongs to the node.
    if (a.secretFile == "-")
        return failed("call", "--secret -: standard input belongs to the node; give a file", launch::kExitUsage);
    auto secret = rsp::readSecret(a.secretFile);
    if (!secret) return failed("call", secret.error().message, launch::kExitUsage);
    auto call = placeOf(a.command[0], a);
    if (!call) return failed("call", call.error().message);
    call->secret = *secret;
    // Drops the path, which only ssh needs: a daemon runs its own binary.
    call->arguments.assign(a.command.begin() + 2, a.command.end());
    const auto status = callNode(*call);
    return status ? status.value() : failed("call", fmt::format("{}: {}", a.command[0], status.error().message));
}

} // namespace mural::cli
