#include "transport/rsp/group_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string_view>
#include <utility>

#include <sodium.h>

namespace mural::rsp {

namespace {

constexpr size_t kMinSecretBytes = 16;

using Unit = std::pair<std::string_view, double>;

// Parses a non-negative number with a unit, case-insensitively.
template <size_t N>
Result<double> numberWithUnit(const std::string& text, const std::array<Unit, N>& units, const char* example) {
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    std::string unit(end, text.data() + text.size());
    std::ranges::transform(unit, unit.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto found = std::ranges::find(units, unit, [](const Unit& u) { return std::string(u.first); });
    if (code != std::errc() || !std::isfinite(value) || value < 0 || found == units.end())
        return Error{"\"" + text + "\" is not valid; write it as " + example};
    return value * found->second;
}

} // namespace

Result<double> parseRate(const std::string& text) {
    static constexpr std::array<Unit, 7> units{Unit{"kbit", 125}, Unit{"mbit", 125e3}, Unit{"gbit", 125e6},
                                               Unit{"kb", 1e3},   Unit{"mb", 1e6},     Unit{"gb", 1e9},
                                               Unit{"", 1}};
    return numberWithUnit(text, units, "200mbit, 1gbit or 25MB");
}

Result<uint64_t> parseSize(const std::string& text) {
    static constexpr std::array<Unit, 4> units{Unit{"k", 1024}, Unit{"m", 1048576}, Unit{"g", 1073741824}, Unit{"", 1}};
    auto value = numberWithUnit(text, units, "1000000, 64k or 256M");
    if (!value) return value.error();
    if (*value >= 0x1p63) return Error{"\"" + text + "\" is too large"};
    return static_cast<uint64_t>(*value);
}

Result<Seal> parseSeal(const std::string& text) {
    if (text == "auto") return bestEncryption();
    for (const Seal seal : {Seal::None, Seal::Tag, Seal::AesGcm, Seal::ChaCha}) {
        if (text != nameOf(seal)) continue;
        if (!available(seal)) return Error{"this machine does not support " + text + "; use auto"};
        return seal;
    }
    return Error{"unknown seal \"" + text + "\"; use auto, siphash, aes-256-gcm, chacha20-poly1305 or none"};
}

Result<ChannelSecret> readSecret(const std::string& path) {
    std::string bytes;
    if (path == "-") {
        bytes.assign(std::istreambuf_iterator<char>(std::cin), {});
    } else {
        std::ifstream file(path, std::ios::binary);
        if (!file)
            return Error{path +
                         ": cannot read the secret; create one with: (umask 077; head -c 32 /dev/urandom | base64 > " +
                         path + ")"};
        using std::filesystem::perms;
        std::error_code unknown;
        if ((std::filesystem::status(path, unknown).permissions() & (perms::others_read | perms::others_write)) !=
                perms::none &&
            !unknown)
            return Error{path +
                         ": every user of this machine can read or change this secret; create a new one, or if it is "
                         "still secret: chmod 600 " +
                         path};
        bytes.assign(std::istreambuf_iterator<char>(file), {});
    }
    while (!bytes.empty() && (bytes.back() == '\n' || bytes.back() == '\r')) bytes.pop_back();
    if (bytes.size() < kMinSecretBytes)
        return Error{path + ": a secret needs at least 16 bytes; create one with: head -c 32 /dev/urandom | base64"};
    ChannelSecret secret;
    if (sodium_init() < 0) return Error{"libsodium cannot be initialized"};
    crypto_generichash(reinterpret_cast<unsigned char*>(secret.data()), secret.size(),
                       reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), nullptr, 0);
    return secret;
}

} // namespace mural::rsp
