// Links to the page: each has a token, a role, an expiry and a limit of open pages. Tokens are 256 random bits, of
// which only the SHA-256 is kept. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "tools/mural/page/access/role.hpp"

namespace mural::page {

inline constexpr size_t kMaxLinks = 64;
inline constexpr int64_t kMaxLinkSeconds = int64_t{365} * 24 * 3600;
inline constexpr int kMaxPagesOfLink = 64;

struct LinkTerms {
    Role role = Role::View;
    int64_t seconds = 8 * 3600; // lifetime; 0: as long as the session
    int most = 20;              // pages that may be open at once; 0: no limit
    std::string name;
};

class LinkTable {
public:
    struct Created {
        int link = 0;
        std::string token; // base64url; this is its only copy
    };
    struct Known {
        int link = 0;
        Role role = Role::View;
        std::string name;
    };
    enum class Refusal { Unknown, Full }; // Unknown: also expired and revoked

    // Times are those of monotonicNowNs(). Errors: too many links; no random numbers.
    Result<Created> create(const LinkTerms& terms, int64_t nowNs);
    // Returns the link of the token. Compares with every link in constant time.
    [[nodiscard]] std::optional<Known> find(std::string_view token, int64_t nowNs) const;
    // Counts an open page of the link. Returns false if as many are open as the link permits.
    [[nodiscard]] bool open(int link);
    void close(int link);
    // Returns whether the link still exists.
    bool revoke(int link);
    [[nodiscard]] bool isValid(int link, int64_t nowNs) const;
    // Returns an array of objects without tokens: link, name, role, secondsLeft (null: no expiry), most, open.
    [[nodiscard]] nlohmann::json list(int64_t nowNs) const;

    // All links with the hashes of their tokens, for a later page of the session.
    [[nodiscard]] nlohmann::json kept(int64_t nowNs) const;
    // Adds the links of kept(). Returns false, and adds none, for anything else.
    bool restore(const nlohmann::json& kept, int64_t nowNs);
    // Ends the oldest links with this name and role, so that at most `most` of them remain.
    void limit(const std::string& name, Role role, size_t most);

private:
    using Hash = std::array<unsigned char, 32>;
    struct Link {
        int number = 0;
        Hash hash{};
        LinkTerms terms;
        int64_t expiresNs = INT64_MAX;
        int open = 0;
    };

    [[nodiscard]] static Hash hashOf(std::string_view token);
    Link* at(int link);
    void dropExpired(int64_t nowNs);

    std::vector<Link> links_;
    int lastNumber_ = 0;
};

// Checks the arguments of the operation `link-new`: role, seconds, most, name, all optional.
Result<LinkTerms> linkTermsOf(const nlohmann::json& arguments);

} // namespace mural::page
