#include <mural/archive/layout.hpp>

#include <xxhash.h>

namespace mural::archive {

namespace {

// Cuts the next field from a layout.
std::string_view nextField(std::string_view& layout) {
    constexpr std::string_view kSeparator = "; ";
    const size_t end = layout.find(kSeparator);
    const std::string_view field = layout.substr(0, end);
    layout.remove_prefix(end == std::string_view::npos ? layout.size() : end + kSeparator.size());
    return field;
}

} // namespace

uint64_t hashOf(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }
uint64_t hashOf(std::string_view text) { return XXH3_64bits(text.data(), text.size()); }

std::string differenceOf(std::string_view here, std::string_view there) {
    for (int number = 1; !here.empty() || !there.empty(); ++number) {
        const std::string_view own = nextField(here), other = nextField(there);
        if (own == other) continue;
        const std::string field = "field " + std::to_string(number);
        if (own.empty()) return field + " is missing here and " + std::string(other) + " there";
        if (other.empty()) return field + " is " + std::string(own) + " here and missing there";
        return field + " is " + std::string(own) + " here and " + std::string(other) + " there";
    }
    return "no field differs";
}

} // namespace mural::archive
