#include "tools/mural/page/hub/output_list.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace mural::page {

namespace {

using Json = nlohmann::json;

std::string areaName(const Json& canvas, const Json& segment) {
    return canvas.at("name").get<std::string>() + "/" + segment.at("name").get<std::string>();
}

const Json* proofOf(const Json& proofs, const Json& node) {
    for (const Json& proof : proofs.at("nodes"))
        if (proof.at("node") == node) return &proof;
    return nullptr;
}

} // namespace

Json areasOf(const Json& wall) {
    Json areas = Json::object();
    const auto canvases = wall.find("canvases");
    if (canvases == wall.end() || canvases->empty()) return areas;
    const Json& canvas = canvases->front();
    const double width = canvas.at("sizePx")[0], height = canvas.at("sizePx")[1];
    if (width <= 0 || height <= 0) return areas;
    for (const Json& segment : canvas.at("segments")) {
        const Json& rect = segment.at("rectPx");
        areas[areaName(canvas, segment)] = {rect[0].get<double>() / width, rect[1].get<double>() / height,
                                            rect[2].get<double>() / width, rect[3].get<double>() / height};
    }
    return areas;
}

// Pixels in a node's own windows precede the head's picture, because they are nearer to the eye.
Json outputList(const Json& wall, const Json& proofs) {
    Json list = Json::array();
    const Json& areas = proofs.at("areas");
    for (const Json& canvas : wall.at("canvases")) {
        for (const Json& segment : canvas.at("segments")) {
            const Json* proof = proofOf(proofs, segment.at("node"));
            if (proof == nullptr) continue;
            const auto area = areas.find(areaName(canvas, segment));
            const bool hasWindows = proof->at("hash").is_string();
            if (!hasWindows && area == areas.end()) continue;
            list.push_back({{"canvas", canvas.at("name")},
                            {"output", segment.at("name")},
                            {"node", segment.at("node")},
                            {"hash", hasWindows ? proof->at("hash") : *area},
                            {"frame", hasWindows ? proof->at("frame") : proofs.at("frame")},
                            {"ageSeconds", proof->at("ageSeconds")},
                            {"skewMs", proof->at("skewMs")}});
        }
    }
    return list;
}

} // namespace mural::page
