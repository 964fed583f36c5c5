// The session's proof that its outputs are alive (docs/reference/control.md, operation `outputs`).
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

#include "nodes/head/broadcast/bytes_of.hpp"
#include "nodes/head/session/head_session.hpp"
#include "nodes/output/picture_hash.hpp"
#include "streamcodec/wire/head_messages.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Proof = OutputProofs::Proof;

constexpr size_t kMaxAreas = 256;
constexpr double kNsInSecond = kNsPerS, kNsInMs = kNsPerMs;

std::string hashText(uint64_t hash) { return fmt::format("{:016x}", hash); }

// Returns x, y, width and height as fractions of the wall, from the upper left corner.
Result<Viewport> areaIn(const std::string& name, const Json& value) {
    const Error wrong{"areas: \"" + name.substr(0, 40) + "\" needs four fractions of the wall: x, y, width, height"};
    if (!value.is_array() || value.size() != 4) return wrong;
    std::array<double, 4> sides{};
    for (size_t i = 0; i < sides.size(); ++i) {
        if (!value[i].is_number()) return wrong;
        sides[i] = value[i].get<double>();
        if (!(sides[i] >= -1 && sides[i] <= 2)) return wrong;
    }
    return Viewport{sides[0], 1 - sides[1] - sides[3], sides[2], sides[3]};
}

// The earliest time at which an output showed each frame; clock of the head.
using FirstShown = std::map<std::pair<uint32_t, uint32_t>, int64_t>;

Json proofJson(const Proof& proof, int64_t shownNs, const FirstShown& first, int64_t nowNs) {
    const wire::OutputProofMessage& message = proof.message;
    const bool hasWindows = message.hash != 0;
    Json skew;
    if (hasWindows) skew = static_cast<double>(shownNs - first.at({message.client, message.frame})) / kNsInMs;
    return {{"node", proof.node},
            {"frame", message.frame},
            {"hash", hasWindows ? Json(hashText(message.hash)) : Json()},
            {"ageSeconds", static_cast<double>(nowNs - proof.requestedNs) / kNsInSecond},
            {"skewMs", std::move(skew)}};
}

} // namespace

void HeadSession::addOutputsOperation(ControlOperations& operations) {
    operations.add({"outputs",
                    "",
                    "the proof that each output is alive: hash, frame and age of its picture; requests the next proof",
                    {{"areas", ControlArgument::Kind::Object, false,
                      "parts of the head's picture to hash: x, y, width, height as fractions, by name"}},
                    [this](const Json& arguments) { return outputsJson(arguments); }});
}

Result<Json> HeadSession::outputsJson(const Json& arguments) {
    const int64_t nowNs = monotonicNowNs();
    Json areas = Json::object();
    const PreviewServer::Latest latest = preview_ ? preview_->latest() : PreviewServer::Latest{};
    if (const auto wanted = arguments.find("areas"); wanted != arguments.end()) {
        if (wanted->size() > kMaxAreas) return Error{"areas: there may be 256 of them"};
        for (const auto& [name, value] : wanted->items()) {
            auto area = areaIn(name, value);
            if (!area) return area.error();
            if (!latest.picture) continue;
            const Picture picture = latest.picture->view();
            areas[name] = hashText(hashOfPart(picture, apply({0, 0, picture.width, picture.height}, *area)));
        }
    }
    if (const auto number = outputProofs_.begin(nowNs))
        nodes_.scheduleSoon(wire::HeadCommand::ProveOutput, bytesOf(wire::ProveOutputCommand{*number}));

    const std::vector<Proof> proofs = outputProofs_.latest();
    const std::vector<NodeClock> clocks = statistics_.clocks();
    const auto shownNsOf = [&clocks](const Proof& proof) {
        const auto node = static_cast<size_t>(proof.node);
        return proof.message.shownNs - (node < clocks.size() && clocks[node].isKnown() ? clocks[node].offsetNs() : 0);
    };
    FirstShown first;
    for (const Proof& proof : proofs) {
        if (proof.message.hash == 0) continue;
        const auto [entry, isNew] = first.try_emplace({proof.message.client, proof.message.frame}, shownNsOf(proof));
        if (!isNew) entry->second = std::min(entry->second, shownNsOf(proof));
    }
    Json nodes = Json::array();
    for (const Proof& proof : proofs)
        if (!hasLeft(proof.node)) nodes.push_back(proofJson(proof, shownNsOf(proof), first, nowNs));
    return Json{{"frame", latest.picture ? Json(latest.frame) : Json()},
                {"areas", std::move(areas)},
                {"nodes", std::move(nodes)}};
}

// Nodes of further canvases have windows of a picture that the page does not show.
Result<void> HeadSession::nodePreviewTile(int node, const wire::PreviewTileHeader& header,
                                          const std::vector<std::byte>& jpeg) {
    const auto stage = plans_.of(node);
    if (stage->plan.nodes[static_cast<size_t>(node)].canvas != 0 || hasLeft(node)) return {};
    return windowPictures_.add(node, header, jpeg);
}

Result<void> HeadSession::nodeOutputProof(int node, const wire::OutputProofMessage& message) {
    outputProofs_.add(node, message);
    return {};
}

} // namespace mural
