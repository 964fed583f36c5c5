#include "balancer/config/eqc/writer.hpp"

#include "balancer/config/global_attributes.hpp"
#include "balancer/config/eqc/attribute_words.hpp"
#include "balancer/config/eqc/section_fields.hpp"
#include "balancer/config/eqc/value_writer.hpp"

namespace mural::config {

namespace {

constexpr size_t kIndent = 4;
constexpr size_t kLineColumns = 110;

// The walker that writes a section. A section whose fields fit on one line takes one line.
class SectionWriter {
public:
    explicit SectionWriter(size_t depth) : depth_(depth) {}

    template <class T> void value(std::string_view word, const std::optional<T>& v) {
        if (!v) return;
        if constexpr (std::is_same_v<T, PixelsOrRange>)
            value(word, *v);
        else
            add(word, valueText(*v));
    }
    void value(std::string_view word, const PixelsOrRange& v) {
        if (v.pixels) add(word, "[ " + valueText(v.pixels->x) + " " + valueText(v.pixels->y) + " ]");
        if (v.range) add(word, valueText(*v.range));
    }
    template <class T>
    requires(std::is_same_v<T, Vector3> || std::is_same_v<T, Degrees2> || std::is_same_v<T, double> ||
             std::is_enum_v<T>) void value(std::string_view word, const T& v) {
        add(word, valueText(v));
    }
    void attribute(std::string_view word, const Attribute& a, AttributeKind kind) {
        if (a) add(word, attributeText(*a, kind));
    }
    template <class T> void repeated(std::string_view word, const std::vector<T>& values) {
        for (const T& v : values) add(word, valueText(v));
    }
    template <class T> void section(std::string_view word, const std::optional<T>& s) {
        if (s) addSection(word, *s);
    }
    template <class T> void sections(std::string_view word, const std::vector<T>& all) {
        for (const T& s : all) addSection(word, s);
    }
    // An attribute section is omitted if no attribute is set.
    template <class T> void merged(std::string_view word, T& s) {
        SectionWriter inner(depth_ + 1);
        fields(inner, s);
        if (!inner.lines_.empty()) addLines(word, inner);
    }
    void merged(std::string_view word, const std::optional<Node>& s) { section(word, s); }
    void surface(const std::optional<ProjectionSurface>& s) {
        if (!s) return;
        if (const auto* wall = std::get_if<Wall>(&*s))
            addSection("wall", *wall);
        else
            addSection("projection", std::get<Projection>(*s));
    }
    void equalizers(const std::vector<Equalizer>& all) {
        for (const Equalizer& e : all) std::visit([&](const auto& one) { addSection(sectionName(one), one); }, e);
    }

    void add(std::string_view word, const std::string& text) { lines_.push_back(std::string(word) + " " + text); }

    template <class T> void addSection(std::string_view word, const T& s) {
        SectionWriter inner(depth_ + 1);
        fields(inner, s);
        addLines(word, inner);
    }

    void addLines(std::string_view word, const SectionWriter& inner) {
        std::string joined = std::string(word) + " {";
        for (const std::string& line : inner.lines_) joined += " " + line;
        joined += " }";
        if (!inner.nested_ && depth_ * kIndent + joined.size() <= kLineColumns) {
            lines_.push_back(joined);
            nested_ = nested_ || inner.lines_.size() > 3;
            return;
        }
        nested_ = true;
        lines_.push_back(std::string(word));
        lines_.emplace_back("{");
        for (const std::string& line : inner.lines_) lines_.push_back(std::string(kIndent, ' ') + line);
        lines_.emplace_back("}");
    }

    [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

private:
    size_t depth_;
    bool nested_ = false; // contains a multi-line section, so it takes several lines too
    std::vector<std::string> lines_;
};

std::string globalText(const GlobalValue& value, GlobalKind kind) {
    if (const auto* number = std::get_if<int32_t>(&value)) {
        const AttributeKind spelling = kind == GlobalKind::Number       ? AttributeKind::Number
                                       : kind == GlobalKind::Statistics ? AttributeKind::Statistics
                                       : kind == GlobalKind::Affinity   ? AttributeKind::Affinity
                                                                        : AttributeKind::Switch;
        return attributeText(*number, spelling);
    }
    return std::visit(
        [](const auto& v) {
            if constexpr (std::is_same_v<std::decay_t<decltype(v)>, int32_t>)
                return std::to_string(v);
            else
                return valueText(v);
        },
        value);
}

} // namespace

std::string writeConfig(const ConfigFile& file) {
    std::string text;
    if (file.version > 0) {
        const std::string version = numberText(file.version);
        text += "#Equalizer " + version + (version.find('.') == std::string::npos ? ".0" : "") + " ascii\n\n";
    }
    for (const std::string& line : file.heading) text += line.empty() ? "#\n" : "# " + line + "\n";
    if (!file.heading.empty()) text += "\n";
    if (!file.globals.empty()) {
        text += "global\n{\n";
        for (const auto& [name, value] : file.globals) {
            const GlobalAttribute* attribute = findGlobalAttribute(name);
            text += "    " + name + " " + globalText(value, attribute != nullptr ? attribute->kind : GlobalKind::Word) +
                    "\n";
        }
        text += "}\n\n";
    }
    SectionWriter server(1);
    server.sections("connection", file.serverConnections);
    server.addSection("config", file.config);
    text += "server\n{\n";
    for (const std::string& line : server.lines()) text += "    " + line + "\n";
    return text + "}\n";
}

} // namespace mural::config
