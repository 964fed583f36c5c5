// Writes the corpus of preview_fuzz. Usage: preview_fuzz_seeds FOLDER. It has two nodes with one and two tiles, and a
// node whose tiles do not change.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "nodes/output/jpeg_picture.hpp"
#include "streamcodec/wire/preview_tile.hpp"

namespace mural::fuzz {
namespace {

constexpr int kWidth = 64, kHeight = 40;

class Seed {
public:
    void add(uint8_t node, uint32_t frame, const PixelViewport& place, uint32_t tiles, uint32_t tile, bool isSame) {
        input_.push_back(static_cast<std::byte>(node));
        for (const uint32_t value : {1U, 1U, frame, 640U, 400U, uint32_t{kWidth}, uint32_t{kHeight}}) half(value);
        for (const int value : {place.x, place.y, place.w, place.h}) half(static_cast<uint32_t>(value));
        half(tiles);
        half(tile);
        OwnedPicture picture(place.w, place.h);
        for (size_t i = 0; i < picture.view().sizeBytes(); ++i)
            picture.data()[i] = static_cast<std::byte>(i * 7 + frame);
        const std::vector<std::byte> jpeg = isSame ? std::vector<std::byte>() : jpegOf(picture.view(), 90);
        half(static_cast<uint32_t>(jpeg.size()));
        input_.insert(input_.end(), jpeg.begin(), jpeg.end());
    }
    void save(const std::filesystem::path& path) const {
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(input_.data()), static_cast<std::streamsize>(input_.size()));
    }

private:
    void half(uint32_t value) {
        input_.push_back(static_cast<std::byte>(value & 0xff));
        input_.push_back(static_cast<std::byte>(value >> 8 & 0xff));
    }
    std::vector<std::byte> input_;
};

void saveAll(const std::filesystem::path& folder) {
    Seed one, two, same;
    one.add(0, 1, {0, 0, kWidth, kHeight}, 1, 0, false);
    one.add(0, 2, {0, 0, kWidth, kHeight}, 1, 0, false);
    two.add(0, 1, {0, 0, kWidth / 2, kHeight}, 1, 0, false);
    two.add(1, 1, {kWidth / 2, 0, kWidth / 2, kHeight / 2}, 2, 0, false);
    two.add(1, 1, {kWidth / 2, kHeight / 2, kWidth / 2, kHeight / 2}, 2, 1, false);
    same.add(2, 1, {0, 0, kWidth, kHeight}, 1, 0, false);
    same.add(2, 2, {0, 0, kWidth, kHeight}, 1, 0, true);
    same.add(2, 3, {kWidth / 2, 0, kWidth / 2, kHeight}, 1, 0, true);
    one.save(folder / "one_node");
    two.save(folder / "two_nodes");
    same.save(folder / "unchanged");
}

} // namespace
} // namespace mural::fuzz

int main(int argc, char** argv) {
    if (argc != 2) return std::fputs("preview_fuzz_seeds FOLDER\n", stderr), 2;
    std::filesystem::create_directories(argv[1]);
    mural::fuzz::saveAll(argv[1]);
    return 0;
}
