// Writes the corpus of the fuzz target of packed pictures: picture_fuzz_seeds FOLDER. It has, for each codec, pictures
// that stay, change in part, and change their size.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "nodes/frame_transfer/picture_packer.hpp"
#include "tests/fuzz/frame_transfer/picture_input.hpp"

namespace mural::fuzz {
namespace {

std::vector<std::byte> slope(int32_t width, int32_t height, unsigned seed) {
    std::vector<std::byte> pixels(static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
    for (size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = static_cast<std::byte>(i % 4 == 3 ? 255 : i / 4 % static_cast<size_t>(width) / 9 + i / 900 + seed);
    return pixels;
}

void append(std::vector<std::byte>& input, uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) input.push_back(static_cast<std::byte>(value >> (8 * i)));
}

void save(const std::filesystem::path& folder, size_t wanted) {
    PicturePacker packer(kWanted[wanted]);
    std::vector<std::byte> input = {static_cast<std::byte>(wanted)};
    const auto add = [&](uint32_t window, int32_t width, int32_t height, const std::vector<std::byte>& pixels) {
        auto packed = packer.pack(1, window, width, height, pixels.data());
        if (!packed || packed->size() > 0xffff) return;
        append(input, window, 1);
        append(input, static_cast<uint32_t>(width - 1), 2);
        append(input, static_cast<uint32_t>(height - 1), 2);
        append(input, static_cast<uint32_t>(packed->size()), 2);
        input.insert(input.end(), packed->begin(), packed->end());
    };
    auto pixels = slope(300, 70, 1);
    add(0, 300, 70, pixels);
    add(0, 300, 70, pixels);
    pixels[0] ^= std::byte{1};
    add(0, 300, 70, pixels);
    add(1, 9, 5, slope(9, 5, 3));
    add(0, 40, 20, slope(40, 20, 2));
    std::ofstream(folder / kWanted[wanted], std::ios::binary)
        .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
}

} // namespace
} // namespace mural::fuzz

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "picture_fuzz_seeds: give the folder of the corpus\n");
        return 2;
    }
    std::filesystem::create_directories(argv[1]);
    for (size_t wanted = 0; wanted < std::size(mural::fuzz::kWanted); ++wanted) mural::fuzz::save(argv[1], wanted);
    return 0;
}
