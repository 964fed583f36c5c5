// Input that no encoder writes.
#include "tests/delta/both_sides.hpp"

namespace mural::delta::testing {
namespace {

std::string problemOf(DeltaDecoder& decoder, const std::function<void(ControlWriter&)>& write,
                      size_t literalBytes = 0) {
    RangeWriter coder;
    ControlWriter control(coder);
    write(control);
    const Bytes literals(literalBytes);
    decoder.begin({coder.finish(), literals, literals, literals, literals}); // spans of zeros: one word each
    for (int packets = 0; packets < 1000; ++packets) {
        uint32_t stream = 0;
        std::span<const std::byte> bytes;
        auto more = decoder.next(stream, bytes);
        if (!more) return more.error().message;
        if (!*more) return "";
    }
    return "endless";
}

std::string problemOf(const std::function<void(ControlWriter&)>& write, size_t literalBytes = 0) {
    DeltaDecoder decoder(tinyLimits());
    return problemOf(decoder, write, literalBytes);
}

TEST(DeltaDecoder, describesErrors) {
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos && text.find("; install the same version") != std::string::npos;
    };
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::Run, 1); }), "a reference to an unknown entry"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::Patch, 1); }), "a delta of an unknown entry"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::NewText, 2); }, 4), "fewer bytes than announced"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::NewText, 0); }), "invalid size"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::NewText, 257); }, 2000), "invalid size"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::NewPage, 1024); }, 5000), "invalid size"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::Seek, 1); }), "before the first"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::Pages, 1), c.number(0); }), "unknown page"));
    EXPECT_TRUE(
        has(problemOf([](ControlWriter& c) { c.put(DeltaOp::Pages, 2), c.number(UINT32_MAX); }), "unknown page"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::ControlOp, 9); }), "unknown"));
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(ControlOp::Stream); }), "end in the middle of a packet"));
    EXPECT_TRUE(
        has(problemOf([](ControlWriter& c) { c.put(DeltaOp::NewText, 1), c.put(ControlOp::Stream), c.number(1); }, 4),
            "another stream"));
    EXPECT_TRUE(has(problemOf(
                        [](ControlWriter& c) {
                            c.put(DeltaOp::NewText, 2), c.put(DeltaOp::Skip, 1), c.put(DeltaOp::Patch, 1), c.span(2, 1);
                        },
                        8),
                    "unknown"));
    EXPECT_TRUE(has(problemOf(
                        [](ControlWriter& c) {
                            c.put(DeltaOp::NewPage, 300), c.put(DeltaOp::Seek, 1), c.put(DeltaOp::Patch, 300),
                                c.put(DeltaOp::Patch, 1);
                        },
                        1200),
                    "fewer words"));
    EXPECT_TRUE(has(problemOf(
                        [](ControlWriter& c) {
                            c.put(DeltaOp::NewText, 2), c.put(DeltaOp::Seek, 1), c.put(DeltaOp::Patch, 1),
                                c.span(UINT32_MAX, 1);
                        },
                        8),
                    "beyond the end"));
    EXPECT_TRUE(has(problemOf(
                        [](ControlWriter& c) {
                            c.put(DeltaOp::NewText, 2), c.put(DeltaOp::Seek, 1), c.put(DeltaOp::Patch, 9), c.span(0, 1),
                                c.span(1, 1);
                        },
                        8),
                    "beyond the end"));
    const auto unchanged = [](ControlWriter& c, uint32_t slot) {
        c.put(ControlOp::CachedBytes), c.number(slot), c.number(2000);
    };
    EXPECT_TRUE(has(problemOf([&](ControlWriter& c) { unchanged(c, 32); }, 2000), "without its owner"));
    EXPECT_TRUE(
        has(problemOf([](ControlWriter& c) { c.put(ControlOp::CachedBytes), c.number(3), c.number(65540); }, 65540),
            "without its owner"));
    EXPECT_TRUE(has(problemOf([&](ControlWriter& c) { unchanged(c, 3); }, 1999), "fewer bytes than announced"));
    EXPECT_TRUE(has(
        problemOf([&](ControlWriter& c) { unchanged(c, 3), c.put(ControlOp::ChangedBytes), c.number(4), c.number(1); },
                  2000),
        "unknown"));
    EXPECT_TRUE(has(
        problemOf([&](ControlWriter& c) { unchanged(c, 3), c.put(ControlOp::ChangedBytes), c.number(32), c.number(1); },
                  2000),
        "unknown"));
    EXPECT_TRUE(
        has(problemOf(
                [&](ControlWriter& c) { unchanged(c, 3), c.put(ControlOp::ChangedBytes), c.number(3), c.number(501); },
                2004),
            "beyond the end"));
    EXPECT_TRUE(has(problemOf(
                        [&](ControlWriter& c) {
                            unchanged(c, 3), c.put(ControlOp::ChangedBytes), c.number(3), c.number(500),
                                c.put(ControlOp::ChangedBytes), c.number(3), c.number(2);
                        },
                        2000),
                    "fewer words"));
    EXPECT_EQ(problemOf(
                  [&](ControlWriter& c) {
                      unchanged(c, 3), c.put(ControlOp::ChangedBytes), c.number(3), c.number(500),
                          c.put(ControlOp::End), c.put(ControlOp::Done);
                  },
                  2000),
              "");
    EXPECT_EQ(problemOf(
                  [](ControlWriter& c) {
                      c.put(DeltaOp::NewPage, 300), c.put(DeltaOp::Seek, 1), c.put(DeltaOp::Patch, 300),
                          c.put(ControlOp::End), c.put(ControlOp::Done);
                  },
                  1200),
              "");
    EXPECT_TRUE(has(problemOf([](ControlWriter& c) { c.put(DeltaOp::NewText, 2), c.put(ControlOp::Done); }, 8),
                    "within a packet"));
    EXPECT_TRUE(
        has(problemOf([](ControlWriter& c) { c.put(DeltaOp::NewText, 2); }, 8), "end in the middle of a packet"));
}

// A few bytes must not make a node decode forever, or into more memory than a packet.
TEST(DeltaDecoder, limitsPacketsAndBatches) {
    EXPECT_NE(problemOf(
                  [](ControlWriter& c) {
                      c.put(DeltaOp::NewText, 256), c.put(DeltaOp::Seek, 1), c.put(DeltaOp::Run, UINT32_MAX);
                  },
                  1024)
                  .find("too large"),
              std::string::npos);
    EXPECT_NE(
        problemOf([](ControlWriter& c) { c.put(ControlOp::Bytes), c.number(UINT32_MAX); }, 1024).find("too large"),
        std::string::npos);
    Limits limits = tinyLimits();
    DeltaDecoder decoder(limits);
    const auto many = [](ControlWriter& c) {
        c.put(DeltaOp::NewText, 256);
        for (int i = 0; i < 100; ++i) c.put(DeltaOp::Seek, 1), c.put(DeltaOp::Run, 1000), c.put(ControlOp::End);
    };
    EXPECT_NE(problemOf(decoder, many, 1024).find("too large"), std::string::npos);
}

} // namespace
} // namespace mural::delta::testing
