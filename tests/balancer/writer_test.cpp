// Written configurations parse to the same configuration, and are written identically again.
#include <gtest/gtest.h>

#include "balancer/config/eqc/parser.hpp"
#include "balancer/config/eqc/value_writer.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "tests/balancer/example_files.hpp"
#include "tests/balancer/random_config.hpp"

namespace mural::config {

namespace {

void expectRoundTrip(const ConfigFile& file) {
    const std::string text = writeConfig(file);
    Diagnostics diagnostics("written");
    const ConfigFile again = parseConfig(text, diagnostics);
    for (const Diagnostic& d : diagnostics.all()) ADD_FAILURE() << diagnostics.text(d);
    EXPECT_TRUE(again == file) << text;
    EXPECT_EQ(writeConfig(again), text);
}

} // namespace

TEST(Writer, roundTripsExampleFiles) {
    const auto files = testing::allFiles();
    for (const auto& path : files) {
        SCOPED_TRACE(path.filename().string());
        Diagnostics diagnostics(path.filename().string());
        const ConfigFile file = readConfigFile(path.string(), diagnostics);
        ASSERT_EQ(diagnostics.errors(), 0) << diagnostics.firstError();
        expectRoundTrip(file);
    }
    if (testing::exampleFiles().empty()) GTEST_SKIP() << testing::noExamples();
}

TEST(Writer, roundTripsRandomConfigurations) {
    for (uint64_t seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        expectRoundTrip(testing::randomConfig(seed));
        if (HasFailure()) return;
    }
}

TEST(Writer, writesNumbersWithoutAnExponent) {
    EXPECT_EQ(numberText(.1), "0.1");
    EXPECT_EQ(numberText(1e-7), "0.0000001");
    EXPECT_EQ(numberText(1e21), "1000000000000000000000");
    EXPECT_EQ(numberText(-3), "-3");
}

} // namespace mural::config
