#include "nodes/render/output_proof.hpp"

#include "nodes/output/picture_hash.hpp"

namespace mural {

wire::OutputProofMessage outputProofOf(const wire::ProveOutputCommand& command, const CompletedFrame& completed,
                                       const ShownTiles* shown) {
    wire::OutputProofMessage proof{};
    proof.number = command.number;
    proof.client = shown != nullptr ? shown->client : completed.client;
    proof.frame = shown != nullptr ? shown->frame : completed.frame;
    proof.shownNs = shown != nullptr ? shown->shownNs : completed.atNs;
    if (shown == nullptr) return proof;
    std::vector<Picture> pictures;
    for (const OwnedPicture& picture : shown->pictures) pictures.push_back(picture.view());
    proof.hash = hashOfPictures(pictures);
    return proof;
}

} // namespace mural
