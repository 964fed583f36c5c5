// Chooses the CPUs near a device (choosePlacement of machine_view.hpp). Pure.
#include <algorithm>
#include <iterator>

#include "nodes/affinity/machine_view.hpp"

namespace mural {
namespace {

// "0-7,16-23"
std::string rangesOf(const std::set<unsigned>& cpus) {
    std::string text;
    for (auto at = cpus.begin(); at != cpus.end();) {
        const unsigned first = *at;
        unsigned last = first;
        while (++at != cpus.end() && *at == last + 1) last = *at;
        text += (text.empty() ? "" : ",") + std::to_string(first);
        if (last > first) text += "-" + std::to_string(last);
    }
    return text;
}

const char* kindName(DeviceKind kind) { return kind == DeviceKind::Gpu ? "GPU" : "network interface that is up"; }

PlacementChoice stay(const std::string& why) { return {{}, "not placed: " + why}; }

} // namespace

PlacementChoice choosePlacement(const MachineView& machine, DeviceKind kind) {
    if (machine.numaNodes < 2) return stay("one NUMA node");
    const DeviceView* best = nullptr;
    int count = 0;
    for (const DeviceView& device : machine.devices) {
        if (device.kind != kind || !device.usable || device.cpus.empty()) continue;
        ++count;
        if (best == nullptr || device.rank > best->rank) best = &device;
    }
    if (best == nullptr) return stay(std::string("no ") + kindName(kind) + " found");
    std::set<unsigned> close;
    std::ranges::set_intersection(best->cpus, machine.allowedCpus, std::inserter(close, close.end()));
    const std::string device = best->name + (count > 1 ? " (of " + std::to_string(count) + ")" : "");
    if (close.empty()) return stay("no core close to " + device + " may be used");
    if (close == machine.allowedCpus) return stay("all cores that may be used are close to " + device);
    return {close, "on cores " + rangesOf(close) + ", near " + device};
}

} // namespace mural
