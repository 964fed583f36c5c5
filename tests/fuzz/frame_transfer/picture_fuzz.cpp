// Feeds arbitrary sequences of packed pictures to the unpacker. An accepted picture can be packed and restored.
#include <algorithm>
#include <string>
#include <vector>

#include "nodes/frame_transfer/picture_packer.hpp"
#include "nodes/frame_transfer/picture_unpacker.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/frame_transfer/picture_input.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) {
    InputReader in(input);
    const char* const codec = kWanted[in.byte() % std::size(kWanted)];
    PictureUnpacker unpacker(codec), again("auto");
    PicturePacker packer("auto");
    uint64_t taken = 0;
    while (!in.empty()) {
        const auto window = static_cast<uint32_t>(in.byte() % kMaxWindows);
        const int32_t width = in.half() % kMaxColumns + 1, height = in.half() % kMaxRows + 1;
        const std::vector<std::byte> message = in.piece();
        std::vector<std::byte> rows(static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
        auto done = unpacker.unpack(1, window, width, height, message, rows);
        if (!done) {
            must(!done.error().message.empty() && done.error().message.find('\n') == std::string::npos,
                 "an error is one line");
            continue;
        }
        ++taken;
        auto packed = packer.pack(1, window, width, height, rows.data());
        must(packed.ok(), "what was taken can be packed");
        std::vector<std::byte> out(rows.size());
        must(again.unpack(1, window, width, height, *packed, out).ok() && out == rows, "nothing is lost on the way");
    }
    return taken;
}

} // namespace mural::fuzz
