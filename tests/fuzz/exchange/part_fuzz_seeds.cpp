// Writes the corpus of part_fuzz. Usage: part_fuzz_seeds FOLDER. It has a part of each kind of depth test, sparse,
// dense and empty, with every codec that the encoder tries.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include "tests/fuzz/exchange/part_input.hpp"

namespace mural::fuzz {
namespace {

enum class Content { Empty, Sparse, Slope, Noise };
constexpr const char* kNames[] = {"empty", "sparse", "slope", "noise"};

constexpr size_t kPartHead = 48; // bytes of a message before its pieces

// Returns the header for readExpectedPart: rows 3 to 69 of a picture of 150 x 70.
std::vector<std::byte> headOf(unsigned how, int32_t width, int32_t height) {
    return {static_cast<std::byte>(how),
            static_cast<std::byte>((width - 1) & 0xff),
            static_cast<std::byte>((width - 1) >> 8),
            static_cast<std::byte>(height - 1),
            std::byte{3},
            static_cast<std::byte>(height - 4)};
}

void draw(PicturePart& part, Content content, bool less, std::mt19937& random) {
    for (int32_t y = 0; y < part.id.box.h; ++y)
        for (int32_t x = 0; x < part.id.box.w; ++x) {
            const bool inside = content == Content::Noise    ? x < 20 && y < 20
                                : content == Content::Slope  ? x > 40
                                : content == Content::Sparse ? x % 97 == 5 && y % 31 == 7
                                                             : false;
            if (!inside) continue;
            const uint32_t depth = content == Content::Noise ? static_cast<uint32_t>(random())
                                                             : 0x40000000U + static_cast<uint32_t>(x * 3 + y) * 0x1000U;
            part.colour[part.at(x, y)] = content == Content::Noise
                                             ? static_cast<uint32_t>(random())
                                             : 0xff000000U + static_cast<uint32_t>(x / 9 * 65536 + y);
            part.depth[part.at(x, y)] = less ? depth & 0xffffff00U : depth | 0x100U;
        }
}

void saveOf(const std::filesystem::path& folder, unsigned how, Content content) {
    std::mt19937 random(1);
    const std::vector<std::byte> head = headOf(how, 150, 70);
    InputReader in(head);
    const ExpectedPart e = readExpectedPart(in);
    PlaneEncoder encoder;
    std::set<std::pair<int, int>> seen; // codecs of colour and depth
    for (int i = 0; i < 400; ++i) { // the encoder measures other codecs meanwhile, and a slow link makes it choose them
        PicturePart part;
        part.id = e.id;
        const auto pixels = static_cast<size_t>(e.id.box.area());
        part.colour.assign(pixels * e.rule.colourWords(), e.rule.clearedColour);
        part.depth.assign(pixels, e.rule.clearedDepth);
        draw(part, content, how % 4 < 2, random);
        const auto message =
            packPart(part, e.rows, e.rule, i % 7 ? PartState::Complete : PartState::Incomplete, encoder);
        encoder.transferred(message.size(), static_cast<int64_t>(message.size()) * (i < 200 ? 1 : 1000));
        const size_t kindAt = kPartHead + 16;
        const auto codecs = message.size() > kindAt + 1 ? std::pair(std::to_integer<int>(message[kindAt]),
                                                                    std::to_integer<int>(message[kindAt + 1]))
                                                        : std::pair(-1, -1);
        if (message.size() > 8192 || !seen.insert(codecs).second) continue;
        std::vector<std::byte> input = head;
        input.insert(input.end(), message.begin(), message.end());
        const std::string name = std::string(kNames[static_cast<size_t>(content)]) + "_" + std::to_string(how) + "_" +
                                 std::to_string(codecs.first) + "_" + std::to_string(codecs.second);
        std::ofstream(folder / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
    }
}

// Saves a picture with a single piece, and the same piece a hundred times. The second would keep a node busy and must
// be rejected.
void saveRepeated(const std::filesystem::path& folder) {
    const std::vector<std::byte> head = headOf(8, 60, 50);
    InputReader in(head);
    const ExpectedPart e = readExpectedPart(in);
    PicturePart part;
    part.id = e.id;
    part.colour.assign(static_cast<size_t>(e.id.box.area()), 0xff000000U);
    part.depth.assign(part.colour.size(), 0x40000000U);
    PlaneEncoder encoder;
    const auto message = packPart(part, e.rows, e.rule, PartState::Complete, encoder);
    std::vector<std::byte> input = head;
    input.insert(input.end(), message.begin(), message.begin() + kPartHead);
    input[head.size() + 44] = std::byte{100};
    for (int i = 0; i < 100; ++i) input.insert(input.end(), message.begin() + kPartHead, message.end());
    std::ofstream(folder / "repeated", std::ios::binary)
        .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
}

} // namespace
} // namespace mural::fuzz

int main(int argc, char** argv) {
    using mural::fuzz::Content;
    if (argc != 2) return std::fputs("part_fuzz_seeds FOLDER\n", stderr), 2;
    std::filesystem::create_directories(argv[1]);
    for (const unsigned how : {0U, 3U, 13U, 14U, 24U, 56U})
        for (const Content content : {Content::Empty, Content::Sparse, Content::Slope, Content::Noise})
            mural::fuzz::saveOf(argv[1], how, content);
    mural::fuzz::saveRepeated(argv[1]);
    return 0;
}
