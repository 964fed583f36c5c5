#include "tools/mural/hosts/host_facts.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace mural::cli {

namespace {

using nlohmann::json;

std::string stringIn(const json& j, const char* name) {
    const auto found = j.find(name);
    return found != j.end() && found->is_string() ? found->get<std::string>() : std::string();
}
uint64_t countIn(const json& j, const char* name) {
    const auto found = j.find(name);
    if (found == j.end() || !found->is_number_integer()) return 0;
    return found->is_number_unsigned() || found->get<int64_t>() >= 0 ? found->get<uint64_t>() : 0;
}
int sizeIn(const json& j, const char* name) { return static_cast<int>(std::min<uint64_t>(countIn(j, name), 1 << 24)); }
bool flagIn(const json& j, const char* name) {
    const auto found = j.find(name);
    return found != j.end() && found->is_boolean() && found->get<bool>();
}
// Positions of monitors may be negative.
int placeIn(const json& j, const char* name) {
    const auto found = j.find(name);
    return found != j.end() && found->is_number_integer() ? static_cast<int>(found->get<int64_t>()) : 0;
}
// The objects of a list.
std::vector<json> objectsIn(const json& j, const char* name) {
    std::vector<json> objects;
    const auto found = j.find(name);
    if (found == j.end() || !found->is_array()) return objects;
    for (const json& each : *found)
        if (each.is_object()) objects.push_back(each);
    return objects;
}

json displayJson(const DisplayFacts& d) {
    json monitors = json::array();
    for (const MonitorFacts& m : d.screen.monitors)
        monitors.push_back({{"name", m.name},
                            {"x", m.x},
                            {"y", m.y},
                            {"width", m.width},
                            {"height", m.height},
                            {"widthMm", m.widthMm},
                            {"heightMm", m.heightMm}});
    return {{"name", d.name},
            {"problem", d.problem},
            {"width", d.screen.width},
            {"height", d.screen.height},
            {"monitors", monitors}};
}

DisplayFacts displayFrom(const json& j) {
    DisplayFacts d;
    d.name = stringIn(j, "name");
    d.problem = stringIn(j, "problem");
    d.screen.width = sizeIn(j, "width");
    d.screen.height = sizeIn(j, "height");
    for (const json& m : objectsIn(j, "monitors"))
        d.screen.monitors.push_back({stringIn(m, "name"), placeIn(m, "x"), placeIn(m, "y"), sizeIn(m, "width"),
                                     sizeIn(m, "height"), sizeIn(m, "widthMm"), sizeIn(m, "heightMm")});
    return d;
}

} // namespace

json toJson(const HostFacts& f) {
    json devices = json::array(), displays = json::array();
    for (const GlDeviceFacts& d : f.devices)
        devices.push_back({{"name", d.name},
                           {"renderer", d.renderer},
                           {"drmNode", d.drmNode},
                           {"pciAddress", d.pciAddress},
                           {"uuid", d.uuid},
                           {"software", d.software}});
    for (const DisplayFacts& d : f.displays) displays.push_back(displayJson(d));
    return {{"build", f.build},
            {"system", f.system},
            {"muralPath", f.muralPath},
            {"user", f.user},
            {"glUsed", f.glUsed},
            {"glProblem", f.glProblem},
            {"renderer", f.renderer},
            {"glVersion", f.glVersion},
            {"maxPictureSize", f.maxPictureSize},
            {"eglProblem", f.eglProblem},
            {"devices", devices},
            {"displays", displays},
            {"seat", {{"name", f.seat.name}, {"user", f.seat.user}, {"type", f.seat.type}}},
            {"closedDrmNodes", f.closedDrmNodes},
            {"hasDrm", f.hasDrm},
            {"openFiles", f.openFiles},
            {"lockedBytes", f.lockedBytes},
            {"sharedMemoryBytes", f.sharedMemoryBytes},
            {"sharedMemoryProblem", f.sharedMemoryProblem},
            {"memoryBytes", f.memoryBytes},
            {"recordingFolder", f.recordingFolder},
            {"recordingFreeBytes", f.recordingFreeBytes}};
}

HostFacts hostFactsFrom(const json& j) {
    HostFacts f;
    f.build = stringIn(j, "build");
    f.system = stringIn(j, "system");
    f.muralPath = stringIn(j, "muralPath");
    f.user = stringIn(j, "user");
    f.glUsed = stringIn(j, "glUsed");
    f.glProblem = stringIn(j, "glProblem");
    f.renderer = stringIn(j, "renderer");
    f.glVersion = stringIn(j, "glVersion");
    f.maxPictureSize = sizeIn(j, "maxPictureSize");
    f.eglProblem = stringIn(j, "eglProblem");
    for (const json& d : objectsIn(j, "devices"))
        f.devices.push_back({stringIn(d, "name"), stringIn(d, "renderer"), stringIn(d, "drmNode"),
                             stringIn(d, "pciAddress"), stringIn(d, "uuid"), flagIn(d, "software")});
    for (const json& d : objectsIn(j, "displays")) f.displays.push_back(displayFrom(d));
    if (const auto seat = j.find("seat"); seat != j.end() && seat->is_object())
        f.seat = {stringIn(*seat, "name"), stringIn(*seat, "user"), stringIn(*seat, "type")};
    if (const auto nodes = j.find("closedDrmNodes"); nodes != j.end() && nodes->is_array())
        for (const json& name : *nodes)
            if (name.is_string()) f.closedDrmNodes.push_back(name.get<std::string>());
    f.hasDrm = flagIn(j, "hasDrm");
    f.openFiles = countIn(j, "openFiles");
    f.lockedBytes = countIn(j, "lockedBytes");
    f.sharedMemoryBytes = countIn(j, "sharedMemoryBytes");
    f.sharedMemoryProblem = stringIn(j, "sharedMemoryProblem");
    f.memoryBytes = countIn(j, "memoryBytes");
    f.recordingFolder = stringIn(j, "recordingFolder");
    f.recordingFreeBytes = countIn(j, "recordingFreeBytes");
    return f;
}

} // namespace mural::cli
