// Writes the corpus of delta_fuzz: the encoder's output for frames that resemble each other.
//   delta_fuzz_seeds FOLDER
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "streamcodec/delta/batch_codec.hpp"
#include "streamcodec/delta/delta_encoder.hpp"
#include "streamcodec/delta/entropy/pixel_filter.hpp"
#include "tests/fuzz/delta/fuzz_limits.hpp"

namespace {

using Bytes = std::vector<std::byte>;
using namespace mural;

void addWord(Bytes& to, uint32_t word) {
    const auto* p = reinterpret_cast<const std::byte*>(&word);
    to.insert(to.end(), p, p + 4);
}

void addSized(Bytes& to, std::span<const std::byte> bytes) {
    const auto size = static_cast<uint16_t>(bytes.size());
    const auto* p = reinterpret_cast<const std::byte*>(&size);
    to.insert(to.end(), p, p + 2);
    to.insert(to.end(), bytes.begin(), bytes.end());
}

Bytes frame(uint32_t seed, uint32_t number, bool pages) {
    std::mt19937 random(seed);
    Bytes bytes;
    for (int i = 0; i < 20; ++i) {
        uint32_t words = 1 + static_cast<uint32_t>(random() % 6);
        if (pages && random() % 5 == 0) words = 200 + static_cast<uint32_t>(random() % 1500);
        addWord(bytes, 64 + static_cast<uint32_t>(random() % 5) + (words << 16));
        for (uint32_t w = 1; w < words; ++w)
            addWord(bytes, static_cast<uint32_t>(random() % 3) + (w == words / 2 && i % 4 == 0 ? number : 0));
        if (number % 3 == 2 && i == 10) i += 3; // some records are missing
    }
    if (number == 4) bytes.resize(bytes.size() - 2);
    return bytes;
}

// Returns a frame of constant size in which a few bytes change: it is kept, and sent as differences.
Bytes plainFrame(uint32_t seed, uint32_t number) {
    std::mt19937 random(seed);
    Bytes bytes;
    for (uint32_t i = 0; i < 100; ++i) {
        addWord(bytes, 64 | 4 << 16);
        for (uint32_t w = 1; w < 4; ++w)
            addWord(bytes, static_cast<uint32_t>(random() % 5) + (i == 10 * number ? number : 0));
    }
    return bytes;
}

Bytes seedOf(uint32_t seed, bool coded, bool pages, bool plain = false) {
    delta::DeltaEncoder encoder(fuzz::fuzzLimits());
    delta::BatchEncoder batchEncoder([](size_t) { return int64_t{0}; });
    Bytes input{static_cast<std::byte>(coded ? 0 : 1)};
    for (uint32_t number = 0; number < 6; ++number) {
        encoder.beginFrame(plain);
        const Bytes bytes = plain ? plainFrame(seed, number) : frame(seed, number, pages);
        encoder.add(0x10000 + seed % 2 * (number % 3), bytes);
        if (coded) {
            const auto batch = batchEncoder.encode(encoder.finish(), 80);
            if (!batch) std::exit(1);
            addSized(input, Bytes(batch.value().begin(), batch.value().end()));
        } else {
            for (const auto section : encoder.finish()) addSized(input, section);
        }
        encoder.clear();
    }
    return input;
}

// Returns a picture next to other data.
Bytes splitSeed(uint32_t seed) {
    std::mt19937 random(seed);
    Bytes pages;
    for (size_t i = 0; i < 2 * delta::kPageBytes; ++i)
        pages.push_back(static_cast<std::byte>(i / 16 % 3 == 0 ? 90 + i % 4 + random() % 3 : 60));
    for (size_t i = 0; i < delta::kPageBytes + 40; ++i) pages.push_back(static_cast<std::byte>(random()));
    delta::PixelFilterEncoder splitter;
    if (!splitter.split(pages)) std::exit(1);
    Bytes input{std::byte{2}};
    for (const size_t number : {pages.size() / 4, splitter.pixelPieces()})
        for (const size_t byte : {number & 255, number >> 8}) input.push_back(static_cast<std::byte>(byte));
    addSized(input, splitter.front());
    input.insert(input.end(), splitter.planes().begin(), splitter.planes().end());
    input.insert(input.end(), splitter.rest().begin(), splitter.rest().end());
    return input;
}

// Returns a picture with little repetition, in a batch as sent.
Bytes photographSeed(uint32_t seed) {
    std::mt19937 random(seed);
    Bytes record;
    // length in words: header, one more, and four pages
    addWord(record, 64 + static_cast<uint32_t>((2 + delta::kPageBytes) << 16));
    addWord(record, seed);
    for (size_t i = 0; i < 4 * delta::kPageBytes; ++i)
        record.push_back(
            static_cast<std::byte>(i < 4 ? 128 : static_cast<uint32_t>(record[record.size() - 4]) + random() % 7 - 3));
    delta::DeltaEncoder encoder(fuzz::fuzzLimits());
    delta::BatchEncoder batchEncoder([](size_t) { return int64_t{0}; });
    encoder.beginFrame(false);
    encoder.add(0x10000, record);
    const auto batch = batchEncoder.encode(encoder.finish(), 80);
    if (!batch) std::exit(1);
    Bytes input{std::byte{0}};
    addSized(input, Bytes(batch.value().begin(), batch.value().end()));
    return input;
}

void write(const std::filesystem::path& path, const Bytes& input) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "delta_fuzz_seeds FOLDER\n");
        return 2;
    }
    std::filesystem::create_directories(argv[1]);
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        for (const bool coded : {false, true}) {
            const Bytes input = seedOf(seed, coded, seed > 2);
            const std::string name =
                std::string(coded ? "coded_" : "sections_") + (seed > 2 ? "pages_" : "records_") + std::to_string(seed);
            write(std::filesystem::path(argv[1]) / name, input);
        }
    }
    for (const bool coded : {false, true})
        write(std::filesystem::path(argv[1]) / (coded ? "coded_plain" : "sections_plain"),
              seedOf(1, coded, false, true));
    for (uint32_t seed = 1; seed <= 2; ++seed)
        write(std::filesystem::path(argv[1]) / ("split_" + std::to_string(seed)), splitSeed(seed));
    write(std::filesystem::path(argv[1]) / "coded_photograph", photographSeed(1));
}
