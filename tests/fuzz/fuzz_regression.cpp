// Passes the given inputs to a fuzz target, then random mutations of them for some seconds. It is the fuzz test without
// libFuzzer. TARGET_regression [--seconds N] [--seed N] FILES…
//
// If a sanitizer or the target itself ends the process, the file last_input of the working directory holds the current
// mutation.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz_target.hpp"

namespace {

using Input = std::vector<std::byte>;
using mural::fuzz::fuzzOne;

Input readFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
    if (!in && text.empty()) {
        std::fprintf(stderr, "fuzz: %s can't be read\n", path.c_str());
        std::exit(1);
    }
    const auto* p = reinterpret_cast<const std::byte*>(text.data());
    return {p, p + text.size()};
}

class Mutator {
public:
    explicit Mutator(uint64_t seed) : random_(seed) {}
    size_t below(size_t n) { return n ? random_() % n : 0; }

    // Returns an input with a few changes: flipped bits, words with typical limits, removed bytes, a part of another
    // input.
    Input mutate(const std::vector<Input>& seeds) {
        Input input = seeds[below(seeds.size())];
        for (size_t n = 1 + below(6); n > 0 && !input.empty(); --n) change(input, seeds[below(seeds.size())]);
        return input;
    }

private:
    void change(Input& input, const Input& other) {
        static constexpr uint32_t kWords[] = {0,          1,          2,          0xff,       0xffff,
                                              0x10000,    0x7fffffff, 0x80000000, 0xfffffffd, 0xfffffffe,
                                              0xffffffff, 0x10000001, 16384,      16385};
        const size_t at = below(input.size());
        switch (below(5)) {
        case 0: input[at] ^= static_cast<std::byte>(1u << below(8)); break;
        case 1:
        case 2: { // records of the stream consist of words after the options byte; network inputs do not
            const size_t word = below(2) ? at / 4 * 4 + 1 : at;
            if (word + 4 <= input.size()) std::memcpy(input.data() + word, &kWords[below(std::size(kWords))], 4);
            break;
        }
        case 3:
            input.erase(input.begin() + static_cast<std::ptrdiff_t>(at),
                        input.begin() + static_cast<std::ptrdiff_t>(std::min(input.size(), at + 4 * below(16))));
            break;
        default: {
            const size_t from = below(other.size()) / 4 * 4 + 1,
                         count = std::min(4 * below(64), other.size() - std::min(other.size(), from));
            if (count)
                input.insert(input.begin() + static_cast<std::ptrdiff_t>(std::min(at / 4 * 4 + 1, input.size())),
                             other.begin() + static_cast<std::ptrdiff_t>(from),
                             other.begin() + static_cast<std::ptrdiff_t>(from + count));
        }
        }
    }
    std::mt19937_64 random_;
};

// Writes the input before each run. Only needed when a sanitizer may end the process at any byte.
void keep(const Input& input) {
    std::ofstream("last_input", std::ios::binary)
        .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
}

} // namespace

int main(int argc, char** argv) {
    double seconds = 0;
    uint64_t seed = 1, runs = 0, meant = 0;
    std::vector<Input> seeds;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--seconds" && i + 1 < argc)
            seconds = std::atof(argv[++i]);
        else if (argument == "--seed" && i + 1 < argc)
            seed = std::strtoull(argv[++i], nullptr, 10);
        else if (std::filesystem::is_directory(argument)) {
            for (const auto& entry : std::filesystem::directory_iterator(argument))
                if (entry.is_regular_file()) seeds.push_back(readFile(entry.path()));
        } else
            seeds.push_back(readFile(argument));
    }
    if (seeds.empty()) {
        std::fprintf(stderr, "fuzz: no input; give files or folders\n");
        return 1;
    }
    for (const Input& input : seeds) meant += fuzzOne(input);
    std::printf("%zu inputs, %llu things in them\n", seeds.size(), static_cast<unsigned long long>(meant));
    if (meant == 0) return 1; // a corpus without effect tests nothing
    Mutator mutator(seed);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (; std::chrono::steady_clock::now() < end; ++runs) {
        const Input input = mutator.mutate(seeds);
        keep(input);
        fuzzOne(input);
    }
    std::printf("%llu mutations\n", static_cast<unsigned long long>(runs));
}
