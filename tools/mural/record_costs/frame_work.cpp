#include "tools/mural/record_costs/frame_work.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/json/json_text.hpp"

namespace mural::cli {

namespace {

struct WindowWork {
    double pixels = 0;                                    // of all its frames
    std::map<uint32_t, std::map<size_t, double>> seconds; // by frame and node
};

// Returns a negative number for a field that is absent or no number.
double numberOf(const nlohmann::json& line, const char* field) {
    const auto found = line.find(field);
    return found != line.end() && found->is_number() ? found->get<double>() : -1;
}

} // namespace

Result<simulation::WorkByFrame> readFrameWork(std::istream& in, size_t nodes, uint32_t firstFrame) {
    std::map<std::pair<double, double>, WindowWork> windows; // by client and window
    std::string text;
    for (size_t number = 1; std::getline(in, text); ++number) {
        const auto line = parseJson(text);
        if (!line.is_object()) return Error{"line " + std::to_string(number) + " is no JSON object"};
        const double frame = numberOf(line, "frame"), node = numberOf(line, "node"),
                     busy = numberOf(line, "busySeconds");
        if (frame < 0 || node < 0 || busy < 0 || !std::isfinite(busy))
            return Error{"line " + std::to_string(number) + " has no frame, node or busySeconds"};
        WindowWork& window = windows[{numberOf(line, "client"), numberOf(line, "window")}];
        window.pixels += numberOf(line, "width") * numberOf(line, "height");
        window.seconds[static_cast<uint32_t>(frame)][static_cast<size_t>(node)] = busy;
    }
    const auto largest = std::ranges::max_element(
        windows, [](const auto& a, const auto& b) { return a.second.pixels < b.second.pixels; });
    simulation::WorkByFrame result;
    if (largest == windows.end()) return result;
    for (const auto& [frame, byNode] : largest->second.seconds) {
        if (frame < firstFrame || byNode.size() != nodes || byNode.rbegin()->first != nodes - 1) continue;
        for (const auto& [node, seconds] : byNode) result[frame].push_back(seconds);
    }
    return result;
}

} // namespace mural::cli
