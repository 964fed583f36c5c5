#include "nodes/render/lost_bits_notice.hpp"

#include "common/log/log.hpp"

namespace mural {

void LostBitsNotice::report(const PlayerOutputs::Frame& frame) {
    const bool losesBits = frame.config.red > 8 && frame.format == PictureFormat::Bgra8;
    if (!losesBits || !reported_.insert({frame.client, frame.window}).second) return;
    log::warning(log::Topic::Picture, "the program's window has ", frame.config.red,
                 " bits per channel; its picture is shown and saved with 8; replies to the program have all bits");
}

void LostBitsNotice::clientGone(uint32_t client) {
    std::erase_if(reported_, [client](const auto& window) { return window.first == client; });
}

} // namespace mural
