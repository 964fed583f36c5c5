// Encoding of the probes of mural doctor --network.
#include "tools/mural/network/probe_datagram.hpp"

#include <gtest/gtest.h>

#include <array>

namespace mural::cli {
namespace {

TEST(ProbeDatagram, decodesItsOwnEncoding) {
    std::array<std::byte, 1472> bytes{};
    writeProbe({0x0123456789abcdef, ProbePath::LinkLocal, true, 1472}, bytes);
    const auto probe = readProbe(bytes);
    ASSERT_TRUE(probe);
    EXPECT_EQ(probe->survey, 0x0123456789abcdefu);
    EXPECT_EQ(probe->path, ProbePath::LinkLocal);
    EXPECT_TRUE(probe->fromDoctor);
    EXPECT_EQ(probe->sizeBytes, 1472);
}

TEST(ProbeDatagram, rejectsTruncatedAndForeignDatagrams) {
    std::array<std::byte, 100> bytes{};
    writeProbe({1, ProbePath::Group, false, 100}, bytes);
    EXPECT_FALSE(readProbe(std::span(bytes).first(99)));
    EXPECT_FALSE(readProbe(std::span(bytes).first(10)));
    EXPECT_FALSE(readProbe({}));
    bytes[16] = std::byte{3};
    EXPECT_FALSE(readProbe(bytes));
    writeProbe({1, ProbePath::Group, false, 100}, bytes);
    bytes[0] = std::byte{'m'};
    EXPECT_FALSE(readProbe(bytes));
}

} // namespace
} // namespace mural::cli
