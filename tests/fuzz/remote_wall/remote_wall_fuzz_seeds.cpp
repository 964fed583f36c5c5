// Writes the corpus of remote_wall_fuzz. Usage: remote_wall_fuzz_seeds FOLDER. It has greetings, replies and events,
// and frames of one and two sources with several codecs.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>

#include "nodes/remote_wall/tile_encoder.hpp"
#include "nodes/remote_wall/wall_message.hpp"

namespace mural::fuzz {
namespace {

using namespace remote;

class Seed {
public:
    void add(uint8_t source, const Message& message) {
        const auto bytes = encode(message);
        if (bytes.size() > UINT16_MAX) return;
        input_.push_back(static_cast<std::byte>(source));
        input_.push_back(static_cast<std::byte>(bytes.size() & 0xff));
        input_.push_back(static_cast<std::byte>(bytes.size() >> 8));
        input_.insert(input_.end(), bytes.begin(), bytes.end());
    }
    void save(const std::filesystem::path& path) const {
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(input_.data()), static_cast<std::streamsize>(input_.size()));
    }

private:
    std::vector<std::byte> input_;
};

OwnedPicture drawn(int width, int height, int step) {
    OwnedPicture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 4 * width; ++x)
            picture.row(y)[x] = static_cast<std::byte>(x / 5 + y * 3 + (x / 64 == step ? 50 : 0));
    return picture;
}

void addFrames(Seed& seed, const std::string& codec, uint8_t sources) {
    for (uint8_t source = 0; source < sources; ++source) {
        TileEncoder encoder(codec, kMinTile);
        for (int frame = 1; frame <= 3; ++frame) {
            const OwnedPicture picture = drawn(72, 40, frame);
            const Picture view = picture.view();
            const auto end = encoder.encode(static_cast<uint64_t>(frame), std::span(&view, 1), [&](const Tile& tile) {
                seed.add(source, tile);
                return Result<void>();
            });
            if (end) seed.add(source, *end);
        }
    }
}

void saveAll(const std::filesystem::path& folder) {
    Seed replies;
    replies.add(0, Hello{kWallVersion, "museum", "jpeg-100", 7, 640, 480, 1, 512, 0, 2});
    replies.add(1, Want{30, 800, 600, true});
    replies.add(0, Ack{1, 2000});
    replies.add(0, Bye{"its window was closed", false});
    Event event;
    event.input.kind = input::InputKind::Wheel;
    event.input.hasPlace = true;
    event.input.x = 0.5, event.input.wheelY = -120;
    replies.add(0, event);
    event.input = {};
    event.input.kind = input::InputKind::Key;
    event.input.code = "k38", event.input.keysym = 97, event.input.isDown = true;
    replies.add(0, event);
    replies.save(folder / "replies");
    for (const char* codec : {"lz4", "bitplane-zstd", "jpeg-90", "yuv420"})
        for (const uint8_t sources : {uint8_t{1}, uint8_t{2}}) {
            Seed frames;
            addFrames(frames, codec, sources);
            frames.save(folder / (std::string(codec) + "_" + std::to_string(sources)));
        }
}

} // namespace
} // namespace mural::fuzz

int main(int argc, char** argv) {
    if (argc != 2) return std::fputs("remote_wall_fuzz_seeds FOLDER\n", stderr), 2;
    std::filesystem::create_directories(argv[1]);
    mural::fuzz::saveAll(argv[1]);
    return 0;
}
