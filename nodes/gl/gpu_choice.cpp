#include "nodes/gl/gpu_choice.hpp"

#include <cctype>

namespace mural::gl {
namespace {

// UUIDs are compared without prefix, hyphens and case.
std::string hexDigitsOf(std::string name) {
    if (name.starts_with("GPU-")) name.erase(0, 4);
    std::string digits;
    for (const char c : name)
        if (c != '-') digits += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return digits;
}

} // namespace

bool matchesGpu(const std::string& name, size_t number, const EglDevice& device) {
    if (name.empty()) return false;
    if (name == std::to_string(number)) return true;
    if (!device.uuid.empty() && hexDigitsOf(name) == device.uuid) return true;
    return name == device.drmNode || name == device.pciAddress;
}

std::string listOf(const std::vector<EglDevice>& devices) {
    std::string list;
    for (size_t i = 0; i < devices.size(); ++i) {
        const EglDevice& device = devices[i];
        list += (i == 0 ? "" : ", ") + std::to_string(i);
        std::string names;
        for (const std::string& name : {device.renderer, device.pciAddress, device.drmNode, device.uuid})
            if (!name.empty()) names += (names.empty() ? "" : ", ") + name;
        if (names.empty() && device.software) names = "software";
        if (!names.empty()) list += " (" + names + ")";
    }
    return list.empty() ? "none" : list;
}

} // namespace mural::gl
