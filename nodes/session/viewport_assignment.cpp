#include "nodes/session/viewport_assignment.hpp"

#include <algorithm>
#include <cstring>

namespace mural {

namespace {

constexpr double kRounding = 1e-9; // tolerates the rounding of decimal fractions
constexpr size_t kNumbers = 5;     // per node

bool inPicture(const Viewport& v) {
    // false for NaN
    return v.x >= 0 && v.y >= 0 && v.w >= 0 && v.h >= 0 && v.x + v.w <= 1 + kRounding && v.y + v.h <= 1 + kRounding;
}

} // namespace

std::vector<std::byte> bytesOf(const ViewportAssignment& areas) {
    const uint32_t head[] = {areas.number, static_cast<uint32_t>(areas.ofNodes.size())};
    std::vector<std::byte> bytes(sizeof head + areas.ofNodes.size() * kNumbers * sizeof(double));
    std::memcpy(bytes.data(), head, sizeof head);
    for (size_t i = 0; i < areas.ofNodes.size(); ++i) {
        const Viewport& v = areas.ofNodes[i];
        const double numbers[kNumbers] = {v.x, v.y, v.w, v.h, areas.zoomOf(i)};
        std::memcpy(bytes.data() + sizeof head + i * sizeof numbers, numbers, sizeof numbers);
    }
    return bytes;
}

std::optional<ViewportAssignment> takeAreas(std::span<const std::byte>& bytes) {
    uint32_t head[2] = {};
    if (bytes.size() < sizeof head) return {};
    std::memcpy(head, bytes.data(), sizeof head);
    const auto rest = bytes.subspan(sizeof head);
    double numbers[kNumbers] = {};
    if (rest.size() / sizeof numbers < head[1]) return {};
    ViewportAssignment areas;
    areas.number = head[0];
    for (size_t i = 0; i < head[1]; ++i) {
        std::memcpy(numbers, rest.data() + i * sizeof numbers, sizeof numbers);
        areas.ofNodes.push_back({numbers[0], numbers[1], numbers[2], numbers[3]});
        areas.zooms.push_back(numbers[4]);
        if (!inPicture(areas.ofNodes.back()) || !(numbers[4] > 0 && numbers[4] <= 1)) return {};
    }
    if (std::ranges::all_of(areas.zooms, [](double zoom) { return zoom == 1; })) areas.zooms.clear();
    bytes = rest.subspan(head[1] * sizeof numbers);
    return areas;
}

} // namespace mural
