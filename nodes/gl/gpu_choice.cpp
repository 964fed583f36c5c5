#include "nodes/gl/gpu_choice.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <sstream>

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

std::vector<std::string> partsOf(const std::string& names) {
    std::vector<std::string> parts;
    std::istringstream text(names);
    for (std::string part; std::getline(text, part, ',');)
        if (!part.empty()) parts.push_back(part);
    return parts;
}

std::optional<size_t> numberOf(const std::string& part) {
    size_t number = 0;
    const char* end = part.data() + part.size();
    const auto [at, error] = std::from_chars(part.data(), end, number);
    return error == std::errc() && at == end ? std::optional(number) : std::nullopt;
}

} // namespace

bool matchesGpu(const std::string& name, size_t number, const EglDevice& device) {
    if (name.empty()) return false;
    if (name == std::to_string(number)) return true;
    if (!device.uuid.empty() && hexDigitsOf(name) == device.uuid) return true;
    return name == device.drmNode || name == device.pciAddress;
}

std::string gpusOfJob(const std::function<const char*(const char* name)>& variable) {
    if (variable("SLURM_JOB_ID") == nullptr) return {};
    // The first two name GPUs of the process, as its device groups number them. The others name GPUs of the host.
    for (const char* name : {"CUDA_VISIBLE_DEVICES", "ROCR_VISIBLE_DEVICES", "SLURM_STEP_GPUS", "SLURM_JOB_GPUS"})
        if (const char* value = variable(name); value != nullptr && *value != '\0') return value;
    return {};
}

std::vector<size_t> selectGpus(const std::string& names, const std::vector<EglDevice>& devices,
                               const std::function<bool(size_t device)>& opens) {
    std::vector<size_t> open;
    for (size_t i = 0; i < devices.size(); ++i)
        if (!devices[i].software && opens(i)) open.push_back(i);
    std::ranges::stable_sort(open, {}, [&](size_t i) { return devices[i].pciAddress; });
    const std::vector<std::string> parts = partsOf(names);
    const bool areNumbers =
        !parts.empty() && std::ranges::all_of(parts, [](const auto& p) { return numberOf(p).has_value(); });
    if (areNumbers && open.size() <= parts.size()) return open; // the others are hidden
    std::vector<size_t> selected;
    for (const std::string& part : parts) {
        const auto number = numberOf(part);
        const std::string digits = hexDigitsOf(part);
        const auto found = std::ranges::find_if(open, [&](size_t i) {
            if (number) return *number < open.size() && open[*number] == i;
            return !digits.empty() && devices[i].uuid.starts_with(digits);
        });
        if (found != open.end() && std::ranges::find(selected, *found) == selected.end()) selected.push_back(*found);
    }
    return selected;
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
