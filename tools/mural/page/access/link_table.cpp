#include "tools/mural/page/access/link_table.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

#include "common/base/clock.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

constexpr size_t kTokenBytes = 32;
constexpr size_t kMaxNameBytes = 64;

std::string base64Url(const unsigned char* bytes, size_t count) {
    std::string text(4 * ((count + 2) / 3) + 1, '\0');
    const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes, static_cast<int>(count));
    text.resize(static_cast<size_t>(length));
    while (!text.empty() && text.back() == '=') text.pop_back();
    std::ranges::replace(text, '+', '-');
    std::ranges::replace(text, '/', '_');
    return text;
}

// Returns nullopt for a value that is no whole number within the limits.
std::optional<int64_t> wholeWithin(const Json& value, int64_t least, int64_t most) {
    if (!value.is_number_integer()) return std::nullopt;
    if (value.is_number_unsigned() && value.get<uint64_t>() > static_cast<uint64_t>(INT64_MAX)) return std::nullopt;
    const auto number = value.get<int64_t>();
    if (number < least || number > most) return std::nullopt;
    return number;
}

} // namespace

Result<LinkTerms> linkTermsOf(const Json& arguments) {
    LinkTerms terms;
    if (!arguments.is_object()) return Error{"the arguments of link-new must be an object"};
    for (const auto& [name, value] : arguments.items()) {
        if (name == "role") {
            const auto role = value.is_string() ? roleOfName(value.get<std::string>()) : std::nullopt;
            if (!role) return Error{"role: expected view, input or operate"};
            terms.role = *role;
        } else if (name == "seconds") {
            const auto seconds = wholeWithin(value, 0, kMaxLinkSeconds);
            if (!seconds) return Error{"seconds: expected a whole number from 0 (no expiry) to 31536000"};
            terms.seconds = *seconds;
        } else if (name == "most") {
            const auto most = wholeWithin(value, 0, kMaxPagesOfLink);
            if (!most) return Error{"most: expected a whole number from 0 (no limit) to 64"};
            terms.most = static_cast<int>(*most);
        } else if (name == "name") {
            if (!value.is_string() || value.get_ref<const std::string&>().size() > kMaxNameBytes)
                return Error{"name: expected a text of at most 64 bytes"};
            terms.name = value.get<std::string>();
        } else {
            return Error{"link-new has no argument \"" + name.substr(0, 40) +
                         "\"; its arguments are role, seconds, most and name"};
        }
    }
    return terms;
}

LinkTable::Hash LinkTable::hashOf(std::string_view token) {
    Hash hash{};
    SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(), hash.data());
    return hash;
}

void LinkTable::dropExpired(int64_t nowNs) {
    std::erase_if(links_, [nowNs](const Link& link) { return link.expiresNs <= nowNs && link.open == 0; });
}

Result<LinkTable::Created> LinkTable::create(const LinkTerms& terms, int64_t nowNs) {
    dropExpired(nowNs);
    if (links_.size() >= kMaxLinks) return Error{"the page has 64 links already; revoke one with mural page revoke"};
    unsigned char bytes[kTokenBytes];
    if (RAND_bytes(bytes, sizeof bytes) != 1) return Error{"the system has no random numbers for a token"};
    Created created{++lastNumber_, base64Url(bytes, sizeof bytes)};
    OPENSSL_cleanse(bytes, sizeof bytes);
    Link& link = links_.emplace_back();
    link.number = created.link;
    link.hash = hashOf(created.token);
    link.terms = terms;
    if (terms.seconds > 0) link.expiresNs = nowNs + terms.seconds * kNsPerS;
    return created;
}

std::optional<LinkTable::Known> LinkTable::find(std::string_view token, int64_t nowNs) const {
    const Hash hash = hashOf(token);
    const Link* found = nullptr;
    for (const Link& link : links_)
        if (CRYPTO_memcmp(hash.data(), link.hash.data(), hash.size()) == 0) found = &link;
    if (found == nullptr || found->expiresNs <= nowNs) return std::nullopt;
    return Known{found->number, found->terms.role, found->terms.name};
}

LinkTable::Link* LinkTable::at(int link) {
    const auto found = std::ranges::find(links_, link, &Link::number);
    return found != links_.end() ? &*found : nullptr;
}

bool LinkTable::open(int link) {
    Link* entry = at(link);
    if (entry == nullptr || (entry->terms.most > 0 && entry->open >= entry->terms.most)) return false;
    ++entry->open;
    return true;
}

void LinkTable::close(int link) {
    if (Link* entry = at(link); entry != nullptr && entry->open > 0) --entry->open;
}

bool LinkTable::revoke(int link) {
    return std::erase_if(links_, [link](const Link& entry) { return entry.number == link; }) > 0;
}

bool LinkTable::isValid(int link, int64_t nowNs) const {
    const auto found = std::ranges::find(links_, link, &Link::number);
    return found != links_.end() && found->expiresNs > nowNs;
}

Json LinkTable::kept(int64_t nowNs) const {
    Json list = Json::array();
    for (const Link& link : links_) {
        if (link.expiresNs <= nowNs) continue;
        list.push_back({{"link", link.number},
                        {"hash", std::vector<int>(link.hash.begin(), link.hash.end())},
                        {"role", nameOf(link.terms.role)},
                        {"expiresNs", link.expiresNs},
                        {"most", link.terms.most},
                        {"name", link.terms.name}});
    }
    return {{"links", std::move(list)}};
}

bool LinkTable::restore(const Json& kept, int64_t nowNs) {
    const auto list = kept.is_object() ? kept.find("links") : kept.end();
    if (list == kept.end() || !list->is_array() || list->size() + links_.size() > kMaxLinks) return false;
    std::vector<Link> restored;
    for (const Json& entry : *list) {
        Link link;
        const auto value = [&entry](const char* name, int64_t least, int64_t most) {
            const auto found = entry.is_object() ? entry.find(name) : entry.end();
            return found == entry.end() ? std::nullopt : wholeWithin(*found, least, most);
        };
        const auto number = value("link", 1, INT32_MAX), most = value("most", 0, kMaxPagesOfLink),
                   expires = value("expiresNs", 0, INT64_MAX);
        if (!number || !most || !expires) return false;
        const Json role = entry.value("role", Json()), name = entry.value("name", Json()),
                   hash = entry.value("hash", Json());
        const auto known = role.is_string() ? roleOfName(role.get<std::string>()) : std::nullopt;
        if (!known || !name.is_string() || !hash.is_array() || hash.size() != link.hash.size()) return false;
        for (size_t i = 0; i < hash.size(); ++i) {
            const auto byte = wholeWithin(hash[i], 0, UINT8_MAX);
            if (!byte) return false;
            link.hash[i] = static_cast<unsigned char>(*byte);
        }
        link.number = static_cast<int>(*number);
        link.terms = {*known, 0, static_cast<int>(*most), name.get<std::string>()};
        link.expiresNs = *expires;
        lastNumber_ = std::max(lastNumber_, link.number);
        if (link.expiresNs > nowNs) restored.push_back(std::move(link));
    }
    links_.insert(links_.end(), restored.begin(), restored.end());
    return true;
}

void LinkTable::limit(const std::string& name, Role role, size_t most) {
    const auto isOne = [&](const Link& link) { return link.terms.name == name && link.terms.role == role; };
    auto surplus = std::ranges::count_if(links_, isOne) - static_cast<std::ptrdiff_t>(most);
    std::erase_if(links_, [&](const Link& link) { return isOne(link) && surplus-- > 0; });
}

Json LinkTable::list(int64_t nowNs) const {
    Json list = Json::array();
    for (const Link& link : links_) {
        if (link.expiresNs <= nowNs) continue;
        Json left = nullptr;
        if (link.expiresNs != INT64_MAX) left = (link.expiresNs - nowNs) / kNsPerS;
        list.push_back({{"link", link.number},
                        {"name", link.terms.name},
                        {"role", nameOf(link.terms.role)},
                        {"secondsLeft", left},
                        {"most", link.terms.most},
                        {"open", link.open}});
    }
    return list;
}

} // namespace mural::page
