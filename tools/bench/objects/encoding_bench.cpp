#include <cstdio>
#include <cstring>
#include <random>

#include "common/base/clock.hpp"
#include "tools/bench/objects/benches.hpp"

namespace mural::bench {

namespace {

template <class Work> double nsOf(int repeats, Work&& work) {
    const int64_t begin = threadCpuNowNs();
    for (int i = 0; i < repeats; ++i) work();
    return static_cast<double>(threadCpuNowNs() - begin) / repeats;
}

void keep(const void* memory) { asm volatile("" : : "r"(memory) : "memory"); }

template <class T> int compare(const char* name, const T& object, size_t sizeBytes, int repeats, int turns) {
    archive::EncodedSlots slots;
    archive::encodeSlots(object, slots);
    const auto bytes = slots.encoder.out().bytes();
    std::vector<std::byte> copy(bytes.begin(), bytes.end());
    T back = object;
    std::vector<double> copies, encodings, decodings, encodeRatios, decodeRatios;
    int wrong = 0;
    for (int turn = 0; turn < turns; ++turn) {
        copies.push_back(nsOf(repeats, [&] {
            std::memcpy(copy.data(), bytes.data(), bytes.size());
            keep(copy.data());
        }));
        encodings.push_back(nsOf(repeats, [&] {
            archive::encodeSlots(object, slots);
            keep(&slots);
        }));
        decodings.push_back(nsOf(repeats, [&] {
            wrong +=
                !archive::decodeSlots(back, UINT64_MAX, nullptr, [&](uint32_t slot) { return slots.bytesOf(slot); });
            keep(&back);
        }));
        encodeRatios.push_back(copies.back() / encodings.back());
        decodeRatios.push_back(copies.back() / decodings.back());
    }
    wrong += !(back == object);
    const Summary copied = summaryOf(copies), encoded = summaryOf(encodings), decoded = summaryOf(decodings);
    const Summary toWrite = summaryOf(encodeRatios), toRead = summaryOf(decodeRatios);
    std::printf("%-22s %9zu %11.0f %11.0f %11.0f   %5.2f (%.2f to %.2f)   %5.2f (%.2f to %.2f)\n", name, sizeBytes,
                copied.median, encoded.median, decoded.median, toWrite.median, toWrite.low, toWrite.high, toRead.median,
                toRead.low, toRead.high);
    return wrong;
}

} // namespace

int benchEncoding(const ObjectBenchOptions& options) {
    std::printf("\nEncoding (CPU ns; rates relative to memcpy of the same bytes, with quartiles)\n");
    std::printf("%-22s %9s %11s %11s %11s   %-21s %s\n", "type", "bytes", "memcpy", "encode", "decode", "encode/memcpy",
                "decode/memcpy");
    std::mt19937 random(1);
    const int turns = options.quick ? 3 : std::min(options.turns, 60);
    const int small = options.quick ? 100 : 20'000;
    BenchState state;
    for (float& sample : state.samples) sample = static_cast<float>(random());
    for (double& number : state.numbers) number = random();
    int wrong = compare("37 fields", state, 1424, small, turns);
    std::vector<float> floats(1'000'000);
    for (float& value : floats) value = static_cast<float>(random());
    wrong += compare("1 M floats", floats, 4 * floats.size(), options.quick ? 1 : 10, turns);
    std::vector<Vector3> places(100'000);
    for (Vector3& place : places) place = {static_cast<double>(random()), 2, 3};
    wrong += compare("100 k Vector3", places, sizeof(Vector3) * places.size(), options.quick ? 1 : 10, turns);
    std::vector<std::string> names(10'000);
    for (std::string& name : names) name.assign(random() % 30, 'x');
    return wrong + compare("10 k texts", names, 19 * names.size(), options.quick ? 1 : 20, turns);
}

} // namespace mural::bench
