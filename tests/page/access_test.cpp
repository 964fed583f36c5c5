// Roles, links, failed logins, hosts, and where the page may listen.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/clock.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/mural/page/access/failure_limit.hpp"
#include "tools/mural/page/access/link_store.hpp"
#include "tools/mural/page/access/link_table.hpp"
#include "tools/mural/page/access/request_origin.hpp"
#include "tools/mural/page/access/role.hpp"
#include "tools/mural/page/page_options.hpp"

namespace mural::page {
namespace {

using Json = nlohmann::json;

TEST(Role, readingOperationsRequireView) {
    for (const char* operation :
         {"status", "nodes", "report", "frames", "help", "equalizers", "preview", "wall", "outputs"})
        EXPECT_EQ(requiredRole(operation, Json::object()), Role::View) << operation;
}

TEST(Role, settingsRequireOperateOnlyWithArguments) {
    for (const char* operation : {"latency", "overlay", "layout", "plan", "log-level"}) {
        EXPECT_EQ(requiredRole(operation, Json::object()), Role::View) << operation;
        EXPECT_EQ(requiredRole(operation, {{"frames", 1}}), Role::Operate) << operation;
    }
}

TEST(Role, unknownAndChangingOperationsRequireOperate) {
    for (const char* operation :
         {"stop", "restart-node", "record-start", "undo", "keep", "links", "link-new", "", "new"})
        EXPECT_EQ(requiredRole(operation, Json::object()), Role::Operate) << operation;
}

TEST(Role, logLinesRequireOperate) {
    EXPECT_EQ(requiredRole("subscribe", {{"topic", "log"}}), Role::Operate);
    EXPECT_EQ(requiredRole("subscribe", {{"topic", "status"}}), Role::View);
    EXPECT_EQ(requiredRole("subscribe", Json::array({"log"})), Role::View); // an error later
}

TEST(Role, namesAreExact) {
    EXPECT_EQ(roleOfName("operate"), Role::Operate);
    EXPECT_EQ(roleOfName("Operate"), std::nullopt);
    EXPECT_EQ(nameOf(Role::Input), "input");
}

class LinkTableTest : public ::testing::Test {
protected:
    LinkTable::Created create(LinkTerms terms) {
        auto created = links_.create(terms, 0);
        EXPECT_TRUE(created.ok());
        return *created;
    }
    LinkTable links_;
};

TEST_F(LinkTableTest, outlivesItsPage) {
    const test::TemporaryFolder folder;
    const std::string path = folder.at("page-links");
    LinkTable none;
    EXPECT_TRUE(restoreLinks(path, none, 0)) << "no file";
    LinkTerms terms;
    terms.role = Role::Input;
    terms.seconds = 60;
    terms.most = 1;
    terms.name = "class";
    const auto kept = create(terms), revoked = create({});
    EXPECT_TRUE(links_.open(kept.link));
    EXPECT_TRUE(links_.revoke(revoked.link));
    ASSERT_TRUE(keepLinks(path, links_, 0).ok());

    LinkTable later;
    ASSERT_TRUE(restoreLinks(path, later, kNsPerS));
    const auto found = later.find(kept.token, kNsPerS);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->role, Role::Input);
    EXPECT_EQ(found->name, "class");
    EXPECT_FALSE(later.find(revoked.token, kNsPerS));
    EXPECT_FALSE(later.find(kept.token, 61 * kNsPerS)) << "it keeps its expiry";
    EXPECT_TRUE(later.open(kept.link)) << "pages of the earlier process do not count";
    EXPECT_FALSE(later.open(kept.link));
    auto next = later.create({}, kNsPerS);
    ASSERT_TRUE(next.ok());
    EXPECT_GT(next->link, kept.link);
    LinkTable expired;
    ASSERT_TRUE(restoreLinks(path, expired, 61 * kNsPerS));
    EXPECT_TRUE(expired.list(61 * kNsPerS).empty());
}

TEST_F(LinkTableTest, restoresNothingFromInvalidLists) {
    const Json good = [this] {
        create({});
        return links_.kept(0);
    }();
    const auto restores = [&](const char* member, const Json& value) {
        Json bad = good;
        bad["links"][0][member] = value;
        LinkTable table;
        const bool isDone = table.restore(bad, 0);
        return isDone || !table.list(0).empty();
    };
    EXPECT_FALSE(restores("role", "owner"));
    EXPECT_FALSE(restores("link", 0));
    EXPECT_FALSE(restores("most", -1));
    EXPECT_FALSE(restores("hash", Json::array({1, 2})));
    EXPECT_FALSE(restores("hash", std::vector<int>(32, 256)));
    EXPECT_FALSE(restores("expiresNs", "soon"));
    EXPECT_FALSE(restores("name", nullptr));
    LinkTable table;
    for (const Json& bad : {Json(), Json::array(), Json{{"links", 3}}, Json{{"links", {1}}}})
        EXPECT_FALSE(table.restore(bad, 0)) << bad;
    EXPECT_TRUE(table.restore(good, 0));
}

TEST_F(LinkTableTest, endsTheOldestOnesAboveALimit) {
    LinkTerms owner;
    owner.role = Role::Operate;
    owner.name = "owner";
    const auto first = create(owner), other = create({}), second = create(owner), third = create(owner);
    links_.limit("owner", Role::Operate, 2);
    EXPECT_FALSE(links_.find(first.token, 0));
    EXPECT_TRUE(links_.find(other.token, 0) && links_.find(second.token, 0) && links_.find(third.token, 0));
    links_.limit("owner", Role::Operate, 5);
    EXPECT_TRUE(links_.find(second.token, 0));
}

TEST_F(LinkTableTest, tokensHave256BitsAndDiffer) {
    std::set<std::string> tokens;
    for (int i = 0; i < 50; ++i) {
        const auto created = create({});
        EXPECT_EQ(created.token.size(), 43U); // 32 bytes in base64url
        EXPECT_EQ(created.token.find_first_of("+/="), std::string::npos);
        tokens.insert(created.token);
    }
    EXPECT_EQ(tokens.size(), 50U);
}

TEST_F(LinkTableTest, findsOnlyTheToken) {
    LinkTerms terms;
    terms.role = Role::Input;
    const auto created = create(terms);
    const auto found = links_.find(created.token, 1);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->role, Role::Input);
    EXPECT_FALSE(links_.find(created.token.substr(1), 1).has_value());
    EXPECT_FALSE(links_.find("", 1).has_value());
    std::string other = created.token;
    other.back() = other.back() == 'A' ? 'B' : 'A';
    EXPECT_FALSE(links_.find(other, 1).has_value());
}

TEST_F(LinkTableTest, expires) {
    LinkTerms terms;
    terms.seconds = 10;
    const auto created = create(terms);
    EXPECT_TRUE(links_.isValid(created.link, 9 * kNsPerS));
    EXPECT_FALSE(links_.isValid(created.link, 10 * kNsPerS));
    EXPECT_FALSE(links_.find(created.token, 10 * kNsPerS).has_value());
}

TEST_F(LinkTableTest, limitsOpenPages) {
    LinkTerms terms;
    terms.most = 2;
    const int link = create(terms).link;
    EXPECT_TRUE(links_.open(link));
    EXPECT_TRUE(links_.open(link));
    EXPECT_FALSE(links_.open(link));
    links_.close(link);
    EXPECT_TRUE(links_.open(link));
}

TEST_F(LinkTableTest, revokedLinksAreUnknown) {
    const auto created = create({});
    EXPECT_TRUE(links_.revoke(created.link));
    EXPECT_FALSE(links_.revoke(created.link));
    EXPECT_FALSE(links_.find(created.token, 0).has_value());
    EXPECT_FALSE(links_.isValid(created.link, 0));
}

TEST_F(LinkTableTest, holdsABoundedNumberOfLinks) {
    for (size_t i = 0; i < kMaxLinks; ++i) create({});
    EXPECT_FALSE(links_.create({}, 0).ok());
    EXPECT_TRUE(links_.create({}, 9 * 3600 * kNsPerS).ok()); // the others have expired
}

TEST_F(LinkTableTest, listsNoTokens) {
    const auto created = create({});
    const std::string text = links_.list(0).dump();
    EXPECT_EQ(text.find(created.token), std::string::npos);
    EXPECT_NE(text.find("\"role\":\"view\""), std::string::npos);
}

TEST(LinkTerms, checksEachArgument) {
    EXPECT_TRUE(linkTermsOf({{"role", "input"}, {"seconds", 60}, {"most", 3}, {"name", "class"}}).ok());
    EXPECT_FALSE(linkTermsOf({{"role", "admin"}}).ok());
    EXPECT_FALSE(linkTermsOf({{"seconds", -1}}).ok());
    EXPECT_FALSE(linkTermsOf({{"seconds", 1e9}}).ok());
    EXPECT_FALSE(linkTermsOf({{"most", 65}}).ok());
    EXPECT_FALSE(linkTermsOf({{"name", std::string(65, 'x')}}).ok());
    EXPECT_FALSE(linkTermsOf({{"other", 1}}).ok());
    EXPECT_FALSE(linkTermsOf(Json::array()).ok());
}

TEST(FailureLimit, tenFailuresPerMinute) {
    FailureLimit limit;
    for (int i = 0; i < 10; ++i) {
        EXPECT_TRUE(limit.permits("10.0.0.1", i));
        limit.failed("10.0.0.1", i);
    }
    EXPECT_FALSE(limit.permits("10.0.0.1", 100));
    EXPECT_TRUE(limit.permits("10.0.0.2", 100));
    EXPECT_TRUE(limit.permits("10.0.0.1", FailureLimit::kWindowNs));
}

TEST(FailureLimit, staysBoundedForManyAddresses) {
    FailureLimit limit;
    for (int i = 0; i < 20'000; ++i) limit.failed(std::to_string(i), i);
    EXPECT_TRUE(limit.permits("another", 20'000));
}

TEST(KnownHosts, refusesForeignNames) {
    const KnownHosts hosts({"127.0.0.1", "localhost", "::1", "Wall.Example"});
    for (const char* own : {"127.0.0.1:8787", "LOCALHOST", "[::1]:80", "wall.example:1"})
        EXPECT_TRUE(hosts.isKnownHost(own)) << own;
    for (const char* other : {"", "evil.example", "127.0.0.1.evil.example", "[::2]", "127.0.0.2", "["})
        EXPECT_FALSE(hosts.isKnownHost(other)) << other;
}

TEST(KnownHosts, requiresTheSameOrigin) {
    const KnownHosts hosts({"localhost"});
    EXPECT_TRUE(hosts.isOwnOrigin("", "localhost:1"));
    EXPECT_TRUE(hosts.isOwnOrigin("http://localhost:1", "localhost:1"));
    EXPECT_FALSE(hosts.isOwnOrigin("http://localhost:2", "localhost:1"));
    EXPECT_FALSE(hosts.isOwnOrigin("http://evil.example", "localhost:1"));
    EXPECT_FALSE(hosts.isOwnOrigin("null", "localhost:1"));
    EXPECT_FALSE(hosts.isOwnOrigin("file://localhost:1", "localhost:1"));
}

TEST(PageAddress, readsEveryForm) {
    const auto of = [](const char* at) {
        auto address = pageAddressOf(at);
        return address ? address->host + " " + std::to_string(address->firstPort) + " " + address->unixPath
                       : std::string("error");
    };
    EXPECT_EQ(of(""), "127.0.0.1 8787 ");
    EXPECT_EQ(of("0.0.0.0"), "0.0.0.0 8787 ");
    EXPECT_EQ(of("wall:90"), "wall 90 ");
    EXPECT_EQ(of(":90"), "127.0.0.1 90 ");
    EXPECT_EQ(of("[::1]:90"), "::1 90 ");
    EXPECT_EQ(of("::1"), "::1 8787 ");
    EXPECT_EQ(of("unix:/run/page"), "127.0.0.1 8787 /run/page");
    for (const char* wrong : {"wall:0", "wall:65536", "wall:x", "[::1", "[::1]9", "unix:page"})
        EXPECT_EQ(of(wrong), "error") << wrong;
}

TEST(PageTls, isRequiredBeyondThisMachine) {
    const auto uses = [](const char* at, const char* tls, bool insecure) {
        PageArguments arguments;
        arguments.tls = tls;
        arguments.isInsecure = insecure;
        auto address = pageAddressOf(at);
        auto result = usesTls(arguments, *address);
        return result ? (*result ? "tls" : "plain") : "refused";
    };
    EXPECT_STREQ(uses("", "auto", false), "plain");
    EXPECT_STREQ(uses("[::1]", "auto", false), "plain");
    EXPECT_STREQ(uses("unix:/run/page", "auto", false), "plain");
    EXPECT_STREQ(uses("0.0.0.0", "auto", false), "tls");
    EXPECT_STREQ(uses("wall1", "auto", false), "tls");
    EXPECT_STREQ(uses("0.0.0.0", "off", false), "refused");
    EXPECT_STREQ(uses("0.0.0.0", "off", true), "plain");
}

TEST(Lifetime, hasUnits) {
    const auto of = [](const char* text) {
        auto seconds = lifetimeOf(text);
        return seconds ? *seconds : -1;
    };
    EXPECT_EQ(of("90"), 90);
    EXPECT_EQ(of("90s"), 90);
    EXPECT_EQ(of("45m"), 2700);
    EXPECT_EQ(of("8h"), 28800);
    EXPECT_EQ(of("2d"), 172800);
    for (const char* wrong : {"", "h", "0h", "-1h", "8w", "1.5h", "366d"}) EXPECT_EQ(of(wrong), -1) << wrong;
}

} // namespace
} // namespace mural::page
