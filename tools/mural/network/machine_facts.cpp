#include "tools/mural/network/machine_facts.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

namespace mural::cli {

namespace {

std::optional<uint64_t> numberIn(const std::string& path) {
    std::ifstream file(path);
    uint64_t value = 0;
    if (file >> value) return value;
    return {};
}

std::vector<std::string> silentBridges(const std::string& root) {
    std::vector<std::string> names;
    std::error_code failed;
    for (const auto& entry : std::filesystem::directory_iterator(root + "/sys/class/net", failed)) {
        const std::string bridge = entry.path().string() + "/bridge";
        if (numberIn(bridge + "/multicast_snooping") == 1 && numberIn(bridge + "/multicast_querier") == 0)
            names.push_back(entry.path().filename());
    }
    std::ranges::sort(names);
    return names;
}

template <class T> void take(const nlohmann::json& j, const char* name, T& into) {
    const auto found = j.find(name);
    if (found == j.end()) return;
    if constexpr (std::is_same_v<T, std::string>) {
        if (found->is_string()) into = found->get<std::string>();
    } else if constexpr (std::is_same_v<T, bool>) {
        if (found->is_boolean()) into = found->get<bool>();
    } else {
        if (found->is_number()) into = found->get<T>();
    }
}

} // namespace

MachineFacts readMachineFacts(const rsp::NetworkInterface& interface, size_t bufferBytes, const std::string& root) {
    MachineFacts f;
    f.interface = interface.name;
    f.mtuBytes = interface.mtuBytes;
    f.linkBytesPerS = interface.bytesPerS;
    f.multicast = interface.multicast;
    f.loopback = interface.loopback;
    f.bufferBytes = bufferBytes;
    f.receiveLimitBytes = numberIn(root + "/proc/sys/net/core/rmem_max");
    f.sendLimitBytes = numberIn(root + "/proc/sys/net/core/wmem_max");
    // The stricter setting applies; 1 is strict, 2 is loose.
    const std::string filters = root + "/proc/sys/net/ipv4/conf/";
    f.strictReturnPath = std::max(numberIn(filters + "all/rp_filter").value_or(0),
                                  numberIn(filters + interface.name + "/rp_filter").value_or(0)) == 1;
    f.silentBridges = silentBridges(root);
    return f;
}

// One line per processor with hexadecimal columns; the second counts drops.
uint64_t droppedByQueues(const std::string& root) {
    std::ifstream file(root + "/proc/net/softnet_stat");
    uint64_t all = 0;
    for (std::string line; std::getline(file, line);) {
        std::istringstream columns(line);
        uint64_t seen = 0, dropped = 0;
        if (columns >> std::hex >> seen >> dropped) all += dropped;
    }
    return all;
}

nlohmann::json toJson(const MachineFacts& f) {
    nlohmann::json j{{"interface", f.interface},
                     {"mtu", f.mtuBytes},
                     {"linkMbit", f.linkBytesPerS * 8e-6},
                     {"multicast", f.multicast},
                     {"loopback", f.loopback},
                     {"bufferBytes", f.bufferBytes},
                     {"strictReturnPath", f.strictReturnPath},
                     {"silentBridges", f.silentBridges}};
    if (f.receiveLimitBytes) j["receiveLimitBytes"] = *f.receiveLimitBytes;
    if (f.sendLimitBytes) j["sendLimitBytes"] = *f.sendLimitBytes;
    return j;
}

MachineFacts machineFactsFrom(const nlohmann::json& j) {
    MachineFacts f;
    double linkMbit = 0;
    take(j, "interface", f.interface);
    take(j, "mtu", f.mtuBytes);
    take(j, "linkMbit", linkMbit);
    f.linkBytesPerS = linkMbit / 8e-6;
    take(j, "multicast", f.multicast);
    take(j, "loopback", f.loopback);
    take(j, "bufferBytes", f.bufferBytes);
    take(j, "strictReturnPath", f.strictReturnPath);
    uint64_t limit = 0;
    if (j.contains("receiveLimitBytes")) take(j, "receiveLimitBytes", limit), f.receiveLimitBytes = limit;
    if (j.contains("sendLimitBytes")) take(j, "sendLimitBytes", limit), f.sendLimitBytes = limit;
    if (const auto bridges = j.find("silentBridges"); bridges != j.end() && bridges->is_array()) {
        for (const auto& name : *bridges)
            if (name.is_string()) f.silentBridges.push_back(name.get<std::string>());
    }
    return f;
}

} // namespace mural::cli
