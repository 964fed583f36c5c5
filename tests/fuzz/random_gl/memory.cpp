#include "tests/fuzz/random_gl/memory.hpp"

#include <GL/gl.h>
#include <cstring>
#include <sys/mman.h>

#include "tests/programs/support/program.hpp"

namespace fuzz {
namespace {

constexpr std::size_t kSectionBytes = 1 << 20;
constexpr std::uintptr_t kInput = 0x510000000000;
constexpr std::uintptr_t kOutput = 0x520000000000;
constexpr std::uintptr_t kLate = 0x530000000000;

template <class T, class Make> void fill(std::byte* section, Make make) {
    for (std::size_t i = 0; i < kSectionBytes / sizeof(T); ++i) {
        const T value = make();
        std::memcpy(section + i * sizeof(T), &value, sizeof(T));
    }
}

std::byte* mapAt(std::uintptr_t address, std::size_t bytes) {
    void* const wanted = reinterpret_cast<void*>(address); // NOLINT: the same in each run
    void* const got = mmap(wanted, bytes, PROT_READ | PROT_WRITE,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE, -1, 0);
    if (got != wanted) {
        programs::fail("no memory at %p", wanted);
    }
    return static_cast<std::byte*>(got);
}

// Returns a section: floats, doubles, ints, shorts, bytes, fixed point, or small numbers for elements of each size.
std::byte* input(std::size_t section) {
    static std::byte* const memory = [] {
        std::byte* const all = mapAt(kInput, 9 * kSectionBytes);
        Random random(1, 1);
        fill<float>(all,
                    [&] { return random.chance(8) ? static_cast<float>(random.between(-3, 40)) : random.around(); });
        fill<double>(all + kSectionBytes, [&] { return static_cast<double>(random.around()); });
        fill<std::int32_t>(all + 2 * kSectionBytes, [&] { return random.between(-2, 40); });
        fill<std::int16_t>(all + 3 * kSectionBytes, [&] { return static_cast<std::int16_t>(random.between(-3, 40)); });
        fill<std::uint8_t>(all + 4 * kSectionBytes, [&] { return static_cast<std::uint8_t>(random.next()); });
        fill<std::int32_t>(all + 5 * kSectionBytes, [&] { return random.between(-80000, 80000); });
        fill<std::uint8_t>(all + 6 * kSectionBytes, [&] { return static_cast<std::uint8_t>(random.below(48)); });
        fill<std::uint16_t>(all + 7 * kSectionBytes, [&] { return static_cast<std::uint16_t>(random.below(48)); });
        fill<std::uint32_t>(all + 8 * kSectionBytes, [&] { return random.below(48); });
        mprotect(all, 9 * kSectionBytes, PROT_READ);
        return all;
    }();
    return memory + section * kSectionBytes;
}

std::size_t section(Type type) {
    switch (type) {
    case Type::Float:
    case Type::Single: return 0;
    case Type::Double: return 1;
    case Type::Int: return 2;
    case Type::Short: return 3;
    case Type::Wide: return 5;
    default: return 4;
    }
}

} // namespace

const void* inputOf(Type type, Random& random) { return input(section(type)) + std::size_t{random.below(2000)} * 8; }

const void* indexMemory(Random& random, std::uint32_t typeEnum) {
    const std::size_t which = typeEnum == GL_UNSIGNED_INT ? 8 : typeEnum == GL_UNSIGNED_SHORT ? 7 : 6;
    return input(which) + std::size_t{random.below(2000)} * 4;
}

const void* vertexMemory(Random& random) {
    return input(0) + (std::size_t{1} << 18) + std::size_t{random.below(500)} * 4;
}

const char* text(Random& random) {
    static const char* const words[] = {"position", "color",    "texCoord", "tint",       "offset", "image",
                                        "scale",    "mode",     "matrix",   "result",     "Block",  "Values",
                                        "varied",   "scale[1]", "nothing",  "gl_Position"};
    return random.of(words);
}

void* outputMemory(std::size_t bytes) {
    static std::byte* const memory = mapAt(kOutput, 2 * kOutputBytes);
    std::memset(memory, 0xcd, bytes);
    return memory;
}

void* lateMemory(std::size_t bytes) {
    static std::byte* const memory = mapAt(kLate, kOutputBytes);
    std::memset(memory, 0xcd, bytes);
    return memory;
}

std::uint64_t digest(const void* bytes, std::size_t count, std::uint64_t before) {
    std::uint64_t sum = before ^ 0xcbf29ce484222325U;
    const auto* from = static_cast<const std::byte*>(bytes);
    for (; count >= 8; count -= 8, from += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, from, 8);
        sum = (sum ^ word) * 0x9fb21c651e98df25U;
        sum ^= sum >> 29;
    }
    for (; count > 0; --count, ++from) {
        sum = (sum ^ static_cast<std::uint8_t>(*from)) * 0x100000001b3U;
    }
    return sum;
}

} // namespace fuzz
