// A walker over section_fields.hpp that fills empty attributes from global attributes. The global name follows from
// section and field: hint_stereo of windows is EQ_WINDOW_IATTR_HINT_STEREO.
#pragma once

#include "balancer/config/global_attributes.hpp"
#include "balancer/config/eqc/section_fields.hpp"

namespace mural::config {

class AttributeFiller {
public:
    AttributeFiller(std::string_view section, const GlobalDefaults& defaults)
        : section_(section), defaults_(defaults) {}

    void attribute(std::string_view word, Attribute& a, AttributeKind) { fill<int32_t>(word, "_IATTR_", a); }
    void value(std::string_view word, std::optional<std::string>& v) { fill<std::string>(word, "_SATTR_", v); }
    void value(std::string_view word, std::optional<char>& v) { fill<char>(word, "_CATTR_", v); }
    void value(std::string_view word, std::optional<double>& v) { fill<double>(word, "_FATTR_", v); }
    void value(std::string_view word, std::optional<ColorMask>& v) { fill<ColorMask>(word, "_IATTR_", v); }
    void value(std::string_view word, std::optional<ConnectionType>& v) { fill<ConnectionType>(word, "_IATTR_", v); }
    void value(std::string_view word, std::optional<uint32_t>& v) {
        std::optional<int32_t> number;
        fill<int32_t>(word, "_IATTR_", number);
        if (!v && number && *number >= 0) v = static_cast<uint32_t>(*number);
    }

private:
    template <class T> void fill(std::string_view word, std::string_view type, std::optional<T>& target) {
        if (target) return;
        std::string name = "EQ_" + std::string(section_) + std::string(type);
        for (const char c : word) name += c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
        target = defaults_.get<T>(name);
    }

    std::string_view section_;
    const GlobalDefaults& defaults_;
};

template <class T> void fillAttributes(T& attributes, std::string_view section, const GlobalDefaults& defaults) {
    AttributeFiller filler(section, defaults);
    fields(filler, attributes);
}

} // namespace mural::config
