// Reads one field of a section: the walker over section_fields.hpp that finds a word and reads its value.
#pragma once

#include "balancer/config/eqc/section_fields.hpp"
#include "balancer/config/eqc/value_reader.hpp"

namespace mural::config {

class SectionReader {
public:
    explicit SectionReader(TokenReader& tokens) : tokens_(tokens) {}

    // Reads "{ ... }". `name` and `at` identify the section in messages.
    template <class Section> void readSection(std::string_view name, SourcePosition at, Section& section) {
        if constexpr (requires { section.at; }) section.at = at;
        if (depth_ >= kDeepest)
            return tokens_.fail(tokens_.peek().at, "more than " + std::to_string(kDeepest) + " sections are nested",
                                "check the brackets");
        ++depth_;
        const std::string_view outer = section_;
        section_ = name;
        if (tokens_.expect('{', name)) {
            while (!tokens_.ended() && !tokens_.peek().is('}')) readField(name, section);
            tokens_.expect('}', "section " + std::string(name));
        }
        finish(section);
        section_ = outer;
        --depth_;
    }

    // Interface of a walker over the fields of a section.
    template <class T> void value(std::string_view word, std::optional<T>& target) {
        if (!isNext(word)) return;
        T read{};
        if constexpr (std::is_same_v<T, PixelsOrRange>) read = target.value_or(T{});
        ValueReader(tokens_, word).read(read);
        target = std::move(read);
    }
    void value(std::string_view word, PixelsOrRange& target) {
        if (isNext(word)) ValueReader(tokens_, word).read(target);
    }
    // Fields that always have a value.
    template <class T>
    requires(std::is_same_v<T, Vector3> || std::is_same_v<T, Degrees2> || std::is_same_v<T, double> ||
             std::is_enum_v<T>) void value(std::string_view word, T& target) {
        if (isNext(word)) ValueReader(tokens_, word).read(target);
    }
    // "eye [ ]" counts as omitted.
    void value(std::string_view word, std::optional<EyeSet>& target) {
        if (!isNext(word)) return;
        EyeSet eyes;
        ValueReader(tokens_, word).read(eyes);
        target = eyes.empty() ? std::nullopt : std::optional(eyes);
    }
    void attribute(std::string_view word, Attribute& target, AttributeKind) {
        if (!isNext(word)) return;
        int32_t read = 0;
        ValueReader(tokens_, word).readAttribute(read);
        target = read;
    }
    template <class T> void repeated(std::string_view word, std::vector<T>& targets) {
        if (isNext(word)) ValueReader(tokens_, word).read(targets.emplace_back());
    }
    template <class T> void section(std::string_view word, std::optional<T>& target) {
        if (isNext(word)) readSection(word, wordAt_, target.emplace());
    }
    template <class T> void sections(std::string_view word, std::vector<T>& targets) {
        if (isNext(word)) readSection(word, wordAt_, targets.emplace_back());
    }
    template <class T> void merged(std::string_view word, T& target) {
        if (isNext(word)) readSection(word, wordAt_, target);
    }
    void merged(std::string_view word, std::optional<Node>& target) {
        if (isNext(word)) readSection(word, wordAt_, target ? *target : target.emplace());
    }
    void surface(std::optional<ProjectionSurface>& target) {
        if (isNext("wall")) {
            Wall wall;
            readSection("wall", wordAt_, wall);
            target = wall;
        } else if (isNext("projection")) {
            Projection projection;
            readSection("projection", wordAt_, projection);
            target = projection;
        }
    }
    void equalizers(std::vector<Equalizer>& targets) {
        tryEqualizer<LoadEqualizer>(targets);
        tryEqualizer<TreeEqualizer>(targets);
        tryEqualizer<DfrEqualizer>(targets);
        tryEqualizer<FramerateEqualizer>(targets);
        tryEqualizer<MonitorEqualizer>(targets);
        tryEqualizer<ViewEqualizer>(targets);
        tryEqualizer<TileEqualizer>(targets);
    }

private:
    static constexpr int kDeepest = 200;

    // Returns true, once, if this is the current word.
    bool isNext(std::string_view word) {
        if (matched_ || word != word_) return false;
        matched_ = true;
        return true;
    }

    template <class E> void tryEqualizer(std::vector<Equalizer>& targets) {
        E equalizer;
        const std::string_view word = sectionName(equalizer);
        if (!isNext(word)) return;
        readSection(word, wordAt_, equalizer);
        targets.emplace_back(std::move(equalizer));
    }

    // Reads the field with this name. Returns false if the section has no such field.
    template <class Section> bool readNamed(std::string_view word, Section& section) {
        const std::string_view outer = word_;
        word_ = word;
        matched_ = false;
        if constexpr (std::is_same_v<Section, Observer>) {
            // places all eyes
            if (word == "eye_base") section.eyeLeft = section.eyeCyclop = section.eyeRight = std::nullopt;
        }
        const SourcePosition at = wordAt_; // nested sections have their own words
        fields(*this, section);
        const bool found = matched_;
        word_ = outer;
        matched_ = true;
        if (found) tokens_.given(at, section_, word);
        return found;
    }

    template <class Section> void readField(std::string_view name, Section& section) {
        const Token& token = tokens_.peek();
        if (token.kind != TokenKind::Word) {
            return tokens_.fail(token.at, shown(token) + " is not a field of section " + std::string(name),
                                "remove it, or check for a missing bracket before it");
        }
        tokens_.take();
        wordAt_ = token.at;
        if (readNamed(token.text, section) || readOldField(token, section)) return;
        if constexpr (requires { section.at; }) {
            if (const std::string_view today = todaysWord(name, token.text); !today.empty()) {
                tokens_.warn(token.at, std::string(token.text) + " was renamed to " + std::string(today), "rename it");
                if (readNamed(today, section)) return;
            }
        }
        skipUnknown(name, token);
    }

    void skipUnknown(std::string_view name, const Token& token);

    // Words of early releases whose value has another form or place (old_fields.cpp).
    template <class Section> bool readOldField(const Token&, Section&) { return false; }
    bool readOldField(const Token& token, Window& window);
    bool readOldField(const Token& token, WindowAttributes& attributes);
    bool readOldField(const Token& token, Connection& connection);
    bool readOldField(const Token& token, Compound& compound);
    bool readOldField(const Token& token, Config& config);
    bool readOldField(const Token& token, ConfigAttributes& attributes);
    void readPrefixed(std::string_view name, std::string_view prefix, WindowAttributes& attributes);
    void readLoadBalancer(SourcePosition at, std::vector<Equalizer>& targets);
    // Moves values that early releases wrote in nested sections into their section.
    template <class Section> void finish(Section&) {}
    void finish(Node& node);
    void finish(Config& config);
    // Returns the current name of a renamed word; empty for other words.
    static std::string_view todaysWord(std::string_view section, std::string_view word);

    TokenReader& tokens_;
    std::string_view section_; // keyword of the current section
    std::string_view word_;
    SourcePosition wordAt_;
    bool matched_ = true;
    int depth_ = 0;
    NodeAttributes oldLaunch_; // launch command in a connection; belongs to the enclosing node
    Observer oldFocus_;        // focus of the configuration; belongs to its observers
};

} // namespace mural::config
