// Feeds arbitrary previews of several nodes to the head. Each is taken or rejected with one line, and each composed
// picture has at most the requested size.
#include <string>

#include "nodes/head/preview/window_pictures.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/preview/preview_input.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) {
    constexpr int kNodes = 3;
    int64_t last = -1;
    uint64_t taken = 0;
    WindowPictures pictures([&](const WindowPictures::Composed& composed) {
        must(composed.picture && composed.picture->width() > 0, "a composed picture has pixels");
        must(composed.picture->width() <= static_cast<int>(kRequestedSide) &&
                 composed.picture->height() <= static_cast<int>(kRequestedSide),
             "a picture is as large as requested");
        must(composed.frame >= last, "frames do not decrease");
        last = composed.frame;
        ++taken;
    });
    (void)pictures.begin(kRequestedSide, kRequestedSide);
    InputReader in(input);
    while (!in.empty()) {
        const int node = in.byte() % kNodes;
        const wire::PreviewTileHeader header = previewHeaderOf(in);
        const std::vector<std::byte> jpeg = in.piece();
        const auto added = pictures.add(node, header, jpeg);
        if (!added)
            must(!added.error().message.empty() && added.error().message.find('\n') == std::string::npos,
                 "an error is one line");
        if (header.number % 16 == 15) pictures.forget(node);
    }
    return taken;
}

} // namespace mural::fuzz
