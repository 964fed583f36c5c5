#include "transport/uuid.hpp"

namespace mural {

namespace {

constexpr std::string_view kDigits = "0123456789abcdef";

bool dashBefore(size_t byte) { return byte == 4 || byte == 6 || byte == 8 || byte == 10; }

int digit(char c) {
    if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
    const size_t at = kDigits.find(c);
    return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

} // namespace

std::string uuidText(const Uuid& uuid) {
    std::string text;
    for (size_t i = 0; i < uuid.size(); ++i) {
        if (dashBefore(i)) text += '-';
        text += kDigits[std::to_integer<size_t>(uuid[i] >> 4)];
        text += kDigits[std::to_integer<size_t>(uuid[i] & std::byte{15})];
    }
    return text;
}

std::optional<Uuid> uuidFromText(std::string_view text) {
    if (text.size() != 36) return {};
    Uuid uuid{};
    size_t at = 0;
    for (size_t i = 0; i < uuid.size(); ++i) {
        if (dashBefore(i) && text[at++] != '-') return {};
        const int high = digit(text[at]), low = digit(text[at + 1]);
        if (high < 0 || low < 0) return {};
        uuid[i] = static_cast<std::byte>(high << 4 | low);
        at += 2;
    }
    return uuid;
}

Uuid markedUuid(Uuid bits) {
    bits[6] = (bits[6] & std::byte{0x0f}) | std::byte{0x80};
    bits[8] = (bits[8] & std::byte{0x3f}) | std::byte{0x80};
    return bits;
}

} // namespace mural
