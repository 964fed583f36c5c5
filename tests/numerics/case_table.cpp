#include "tests/numerics/case_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace mural::numerics {

namespace {

struct Row {
    std::string what, against, unit, result;
    double off = 0, maximum = 0;
    bool holds = true;
};

std::vector<Row>& rows() {
    static std::vector<Row> all;
    return all;
}

Row& rowOf(const std::string& what, const std::string& against) {
    const auto found =
        std::ranges::find_if(rows(), [&](const Row& r) { return r.what == what && r.against == against; });
    if (found != rows().end()) return *found;
    rows().push_back({what, against, {}, {}, 0, 0, true});
    return rows().back();
}

// A test that reports no number compares for equality or has its own bounds; its row is its name.
class Tests : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override { before_ = rows().size(); }
    void OnTestEnd(const testing::TestInfo& test) override {
        if (rows().size() != before_ || test.result()->Skipped()) return;
        rows().push_back({std::string(test.test_suite_name()) + "." + test.name(),
                          "what the test computes it by",
                          {},
                          test.result()->Passed() ? "passed" : "failed",
                          0,
                          0,
                          test.result()->Passed()});
    }
    size_t before_ = 0;
};

// Printed after gtest's own lines; --gtest_brief=1 omits those.
class Table : public testing::Environment {
    void SetUp() override { testing::UnitTest::GetInstance()->listeners().Append(new Tests); } // gtest owns it
    void TearDown() override {
        if (rows().empty()) return;
        std::printf("\n| case | against | off by | at most | |\n|---|---|---|---|---|\n");
        for (const Row& r : rows()) {
            if (r.result.empty())
                std::printf("| %s | %s | %.3g %s | %.3g | %s |\n", r.what.c_str(), r.against.c_str(), r.off,
                            r.unit.c_str(), r.maximum, r.holds ? "holds" : "BROKEN");
            else
                std::printf("| %s | %s | %s | | %s |\n", r.what.c_str(), r.against.c_str(), r.result.c_str(),
                            r.holds ? "holds" : "BROKEN");
        }
    }
};
// gtest owns it
[[maybe_unused]] const testing::Environment* const kTable = testing::AddGlobalTestEnvironment(new Table);

} // namespace

void expectWithin(const std::string& what, const std::string& against, double off, double maximum,
                  const std::string& unit) {
    Row& row = rowOf(what, against);
    const bool within = off <= maximum; // false for NaN as well
    if (row.holds) row.off = within ? std::max(row.off, off) : off;
    row.maximum = maximum;
    row.unit = unit;
    row.holds = row.holds && within;
    EXPECT_TRUE(within) << what << ", against " << against << ": off by " << off << " " << unit << ", at most "
                        << maximum << " is right";
}

void expectThat(const std::string& what, const std::string& against, bool holds, const std::string& result) {
    Row& row = rowOf(what, against);
    row.result = result;
    row.holds = row.holds && holds;
    EXPECT_TRUE(holds) << what << ", against " << against << ": " << result << " does not hold";
}

} // namespace mural::numerics
