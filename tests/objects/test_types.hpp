// Object types of the tests.
#pragma once

#include <map>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include <mural/archive.hpp>

namespace mural::test {

enum class Shade : uint16_t { Flat = 7, Smooth = 900 };

struct Light {
    Vector3 place;
    float power = 1;
    template <class Visit> void fields(Visit& visit) { visit(place, power); }
    friend bool operator==(const Light&, const Light&) = default;
};

// A class with cereal's member function.
struct Material {
    std::string name;
    Shade shade = Shade::Flat;
    template <class Archive> void serialize(Archive& archive) { archive(name, shade); }
    friend bool operator==(const Material&, const Material&) = default;
};

// Contains lists of its own type.
struct Tree {
    int32_t value = 0;
    std::vector<Tree> children;
    template <class Visit> void fields(Visit& visit) { visit(value, children); }
    friend bool operator==(const Tree&, const Tree&) = default;
};

// Every kind of field.
struct Everything {
    bool flag = false;
    char letter = 'a';
    int8_t i8 = -8;
    uint8_t u8 = 8;
    int16_t i16 = -16;
    uint16_t u16 = 16;
    int32_t i32 = -32;
    uint32_t u32 = 32;
    int64_t i64 = -64;
    uint64_t u64 = 64;
    float f32 = .5F;
    double f64 = .25;
    Shade shade = Shade::Smooth;
    std::array<float, 3> colour{1, 2, 3};
    int16_t pair[2] = {4, 5};
    std::vector<double> samples;
    std::vector<bool> bits;
    std::vector<std::string> names;
    std::string title;
    std::optional<Light> sun;
    std::variant<std::monostate, int32_t, std::string> choice;
    std::map<std::string, int32_t> counts;
    std::pair<int32_t, std::string> both;
    std::vector<Light> lights;
    Material material;
    Tree tree;
    Matrix4 pose;
    Viewport viewport;
    PixelViewport pixels;
    Range range;
    Eye eye = Eye::Left;
    Blob mesh;
    Ref<Tree> other;

    template <class Visit> void fields(Visit& v) {
        v(flag, letter, i8, u8, i16, u16, i32, u32, i64, u64, f32, f64, shade, colour, pair);
        v(samples, bits, names, title, sun, choice, counts, both, lights, material, tree);
        v(pose, viewport, pixels, range, eye, mesh, other);
    }
    friend bool operator==(const Everything&, const Everything&) = default;
};

inline std::string randomText(std::mt19937_64& random) {
    std::string text(random() % 20, ' ');
    for (char& letter : text) letter = static_cast<char>(random());
    return text;
}

inline Tree randomTree(std::mt19937_64& random, int depth) {
    Tree tree{static_cast<int32_t>(random()), {}};
    for (size_t i = depth > 0 ? random() % 3 : 0; i > 0; --i) tree.children.push_back(randomTree(random, depth - 1));
    return tree;
}

inline Everything randomEverything(std::mt19937_64& random) {
    Everything e;
    e.flag = random() % 2 != 0;
    e.i64 = static_cast<int64_t>(random());
    e.f64 = static_cast<double>(random());
    e.samples.resize(random() % 100);
    for (double& sample : e.samples) sample = static_cast<double>(random());
    for (size_t i = random() % 20; i > 0; --i) e.bits.push_back(random() % 2 != 0);
    for (size_t i = random() % 5; i > 0; --i) e.names.push_back(randomText(random));
    e.title = randomText(random);
    if (random() % 2) e.sun = Light{{1, 2, static_cast<double>(random() % 9)}, 4};
    switch (random() % 3) {
    case 0: e.choice = 5; break;
    case 1: e.choice = randomText(random); break;
    default: break;
    }
    for (size_t i = random() % 5; i > 0; --i) e.counts[randomText(random)] = static_cast<int32_t>(i);
    e.both = {3, randomText(random)};
    e.lights.resize(random() % 4);
    e.material.name = randomText(random);
    e.tree = randomTree(random, 4);
    e.pose = Matrix4::translation({1, 2, 3});
    e.pixels = {1, 2, 3, static_cast<int32_t>(random() % 1000)};
    e.range = {.25, .5};
    e.other.id[3] = std::byte{9};
    e.other.version = random();
    return e;
}

} // namespace mural::test
