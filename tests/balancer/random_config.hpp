// Configurations with random values in all fields: meaningless, but each can be written and parsed.
#pragma once

#include <random>

#include "balancer/config/global_attributes.hpp"
#include "balancer/config/eqc/section_fields.hpp"

namespace mural::config::testing {

// A walker over section_fields.hpp that sets about half of the fields.
class RandomFiller {
public:
    explicit RandomFiller(uint64_t seed) : random_(seed) {}

    bool chance(double probability) { return std::uniform_real_distribution<>(0, 1)(random_) < probability; }
    int32_t number(int32_t from, int32_t to) { return std::uniform_int_distribution<int32_t>(from, to)(random_); }
    double real() {
        switch (number(0, 3)) {
        case 0: return number(-5, 5);
        case 1: return number(-1000, 1000) / 1000.;
        case 2: return std::ldexp(std::uniform_real_distribution<>(-1, 1)(random_), number(-60, 60));
        default: return std::uniform_real_distribution<>(0, 1)(random_);
        }
    }

    template <class T> void value(std::string_view, std::optional<T>& v) {
        if (chance(.5)) fill(v.emplace());
    }
    template <class T> void value(std::string_view, T& v) { fill(v); }
    void attribute(std::string_view, Attribute& a, AttributeKind) {
        if (chance(.5)) a = chance(.5) ? number(-17, 40) : number(-65536, 65536);
    }
    template <class T> void repeated(std::string_view, std::vector<T>& values) {
        for (int32_t n = number(0, 2); n > 0; --n) fill(values.emplace_back());
    }
    template <class T> void section(std::string_view, std::optional<T>& s) {
        if (chance(.5)) fields(*this, s.emplace());
    }
    template <class T> void sections(std::string_view, std::vector<T>& all) {
        if (++depth_ < 9) {
            for (int32_t n = number(0, 2); n > 0; --n) fields(*this, all.emplace_back());
        }
        --depth_;
    }
    template <class T> void merged(std::string_view, T& s) { fields(*this, s); }
    void merged(std::string_view word, std::optional<Node>& s) { section(word, s); }
    void surface(std::optional<ProjectionSurface>& s) {
        if (chance(.3))
            fields(*this, s.emplace(Wall{}).emplace<Wall>());
        else if (chance(.3))
            fields(*this, s.emplace(Projection{}).emplace<Projection>());
    }
    void equalizers(std::vector<Equalizer>& all) {
        if (chance(.3)) add<LoadEqualizer>(all);
        if (chance(.3)) add<TreeEqualizer>(all);
        if (chance(.3)) add<DfrEqualizer>(all);
        if (chance(.2)) add<FramerateEqualizer>(all);
        if (chance(.2)) add<MonitorEqualizer>(all);
        if (chance(.2)) add<ViewEqualizer>(all);
        if (chance(.2)) add<TileEqualizer>(all);
    }

    void fill(std::string& v) {
        static constexpr std::string_view kCharacters = "abcXYZ 0123-\\.,_%&@<>:!/=+();~$*'#{}[]\t\xc3\xa4";
        for (int32_t n = number(0, 12); n > 0; --n)
            v += kCharacters[static_cast<size_t>(number(0, static_cast<int32_t>(kCharacters.size()) - 1))];
    }
    void fill(char& v) { v = "'\"x%"[number(0, 3)]; }
    void fill(double& v) { v = real(); }
    void fill(uint32_t& v) { v = static_cast<uint32_t>(number(0, 100000)); }
    void fill(Viewport& v) { v = {real(), real(), real(), real()}; }
    void fill(Vector3& v) { v = {real(), real(), real()}; }
    void fill(Degrees2& v) { v = {real(), real()}; }
    void fill(Range& v) { v = {real(), real()}; }
    void fill(Zoom& v) { v = {real(), real()}; }
    void fill(Bezel& v) { v = {real(), real(), real(), real()}; }
    void fill(PixelKernel& v) { v = {number(0, 9), number(0, 9), number(0, 9), number(0, 9)}; }
    void fill(SubPixel& v) { v = {number(0, 9), number(0, 9)}; }
    void fill(PixelsOrRange& v) {
        if (chance(.4)) v.pixels = Pixels2{static_cast<uint32_t>(number(0, 99)), 7};
        if (chance(.4)) v.range = real();
    }
    void fill(Reference& v) {
        if (chance(.5))
            v = static_cast<uint32_t>(number(0, 9));
        else
            fill(v.emplace<std::string>());
    }
    void fill(LayoutReference& v) {
        if (chance(.3))
            v = static_cast<uint32_t>(number(0, 9));
        else if (chance(.5))
            fill(v.emplace<std::string>());
    }
    void fill(ChannelReference& v) {
        if (chance(.5)) return fill(v.emplace<std::string>());
        auto& path = v.emplace<ChannelPath>();
        for (int32_t n = number(0, 4); n > 0; --n) {
            path.steps.emplace_back();
            fill(path.steps.back().first);
            fill(path.steps.back().second);
        }
    }
    template <class E>
    requires std::is_enum_v<E>
    void fill(E& v) {
        const auto all = spellings(E{});
        v = all[static_cast<size_t>(number(0, static_cast<int32_t>(all.size()) - 1))].value;
    }
    template <class E> void fill(EnumSet<E>& v) {
        for (const auto& s : spellings(E{})) {
            if (chance(.5)) v.add(s.value);
        }
        if constexpr (std::is_same_v<E, Eye>) v.add(Eye::Cyclop); // an empty set of eyes is not written
    }

private:
    template <class E> void add(std::vector<Equalizer>& all) {
        E e;
        fields(*this, e);
        all.emplace_back(e);
    }

    std::mt19937_64 random_;
    int depth_ = 0;
};

inline ConfigFile randomConfig(uint64_t seed) {
    RandomFiller filler(seed);
    ConfigFile file;
    file.version = std::array{0., 1., 1.1, 1.2}[static_cast<size_t>(filler.number(0, 3))];
    if (filler.chance(.5)) file.heading = {"Equalizer, or not", "", "  a second line"};
    for (const GlobalAttribute& g : globalAttributes()) {
        if (!filler.chance(.3)) continue;
        GlobalValue& value = file.globals[std::string(g.name)];
        if (g.kind == GlobalKind::Length)
            filler.fill(value.emplace<double>());
        else if (g.kind == GlobalKind::Text)
            filler.fill(value.emplace<std::string>());
        else if (g.kind == GlobalKind::Character)
            filler.fill(value.emplace<char>());
        else if (g.kind == GlobalKind::Mask)
            filler.fill(value.emplace<ColorMask>());
        else if (g.kind == GlobalKind::ConnectionType)
            filler.fill(value.emplace<ConnectionType>());
        else
            value = filler.number(-17, 40);
    }
    filler.sections("connection", file.serverConnections);
    fields(filler, file.config);
    return file;
}

} // namespace mural::config::testing
