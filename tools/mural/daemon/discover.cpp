#include "tools/mural/daemon/discover.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "nodes/launch/program_check.hpp"

namespace mural::cli {

namespace {

std::string meansOf(const FoundNode& n) {
    return n.byBeacon && n.byAvahi ? "beacon, avahi" : n.byBeacon ? "beacon" : "avahi";
}

void printJson(const Discovered& d) {
    nlohmann::json nodes = nlohmann::json::array();
    for (const FoundNode& n : d.nodes) {
        nlohmann::json means = nlohmann::json::array();
        if (n.byBeacon) means.push_back("beacon");
        if (n.byAvahi) means.push_back("avahi");
        nodes.push_back({{"name", n.name},
                         {"uuid", uuidText(n.uuid)},
                         {"addresses", n.addresses},
                         {"port", n.port},
                         {"version", n.version},
                         {"by", means}});
    }
    const nlohmann::json all{{"nodes", nodes}, {"beaconTrouble", d.beaconTrouble}, {"avahiTrouble", d.avahiTrouble}};
    fmt::print("{}\n", jsonText(all));
}

void printTable(const Discovered& d) {
    size_t nameColumns = 6;
    for (const FoundNode& n : d.nodes) nameColumns = std::max(nameColumns, n.name.size() + 1);
    if (!d.nodes.empty())
        fmt::print("{:<{}}{:<38}{:<7}{:<9}{:<15}{}\n", "name", nameColumns, "uuid", "port", "version", "by",
                   "addresses");
    for (const FoundNode& n : d.nodes) {
        std::string addresses;
        for (const std::string& a : n.addresses) addresses += (addresses.empty() ? "" : " ") + a;
        fmt::print("{:<{}}{:<38}{:<7}{:<9}{:<15}{}\n", n.name, nameColumns, uuidText(n.uuid), n.port, n.version,
                   meansOf(n), addresses);
    }
}

} // namespace

void describeDiscover(CLI::App& command, DiscoverArguments& a) {
    command.add_option("--seconds", a.seconds, "search time in seconds (2)")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.1, 600.0));
    command
        .add_option("--interface", a.interface,
                    "network interface of the beacon, name or address (all multicast interfaces)")
        ->type_name("NAME");
    command.add_flag("--no-beacon", a.noBeacon, "search with Avahi only");
    command.add_flag("--no-avahi", a.noAvahi, "search with the beacon only");
    command.add_flag("--json", a.asJson, "print one line of JSON");
}

int discoverCommand(const DiscoverArguments& a) {
    if (a.noBeacon && a.noAvahi) {
        fmt::print(stderr, "mural discover: --no-beacon and --no-avahi exclude both methods; omit one of them\n");
        return launch::kExitUsage;
    }
    const Discovered d =
        discoverNodes({!a.noBeacon, !a.noAvahi, a.interface}, Deadline::inMs(static_cast<int64_t>(a.seconds * 1000)));
    if (a.asJson)
        printJson(d);
    else
        printTable(d);
    if (!d.nodes.empty()) return 0;
    if (a.asJson) return 1;
    fmt::print(stderr, "mural discover: no daemon in this network; start one with: mural node --wait --secret FILE\n");
    // The beacon works without Avahi, so problems are reported only if nothing was found.
    for (const std::string& trouble : {d.beaconTrouble, d.avahiTrouble})
        if (!trouble.empty()) fmt::print(stderr, "mural discover: searched in part: {}\n", trouble);
    return 1;
}

} // namespace mural::cli
