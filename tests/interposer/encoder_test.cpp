// The render nodes' decoder reads the output of the generated encoders.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "common/ipc/capture_ring.hpp"
#include "encoders.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "tests/interposer/encoder_harness.hpp"
#include "tests/interposer/record_reader.hpp"

namespace mural::testing {
namespace {

std::vector<std::byte> counting(size_t n) {
    std::vector<std::byte> bytes(n);
    for (size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::byte>(i * 7 + i / 256);
    return bytes;
}
std::vector<std::byte> copyOf(const Data& d) { return {d.span().begin(), d.span().end()}; }

class EncoderTest : public ::testing::Test {
protected:
    // Passes the arguments of the only encoded record to `read`, which must consume all of them.
    template <class F> void theRecord(uint16_t opcode, const F& read) {
        const auto bytes = harness_.takeBytes();
        ASSERT_EQ(bytes.size() % 4, 0u);
        RecordReader reader(bytes);
        ReadRecord r;
        ASSERT_TRUE(reader.next(r));
        EXPECT_EQ(r.opcode, opcode);
        Args in(r.arguments, reader);
        read(in);
        EXPECT_TRUE(in.ok());
        EXPECT_EQ(in.left(), 0u);
        EXPECT_EQ(reader.blobsLeft(), 0u);
        EXPECT_FALSE(reader.next(r));
        EXPECT_FALSE(reader.broken());
    }
    EncoderHarness harness_;
    ThreadState& t_ = harness_.thread();
};

TEST_F(EncoderTest, encodesScalarsOfAllWidths) {
    encode_glNormal3b(t_, -128, 127, -1);
    theRecord(op::glNormal3b, [](Args& in) {
        EXPECT_EQ(in.narrow<GLbyte>(), -128);
        EXPECT_EQ(in.narrow<GLbyte>(), 127);
        EXPECT_EQ(in.narrow<GLbyte>(), -1);
    });
    encode_glVertex2s(t_, -32768, 32767);
    theRecord(op::glVertex2s, [](Args& in) {
        EXPECT_EQ(in.narrow<GLshort>(), -32768);
        EXPECT_EQ(in.narrow<GLshort>(), 32767);
    });
    encode_glVertex3f(t_, 1.5f, -0.0f, 3e38f);
    theRecord(op::glVertex3f, [](Args& in) {
        EXPECT_EQ(in.get<GLfloat>(), 1.5f);
        EXPECT_TRUE(std::signbit(in.get<GLfloat>()));
        EXPECT_EQ(in.get<GLfloat>(), 3e38f);
    });
    encode_glVertex3d(t_, 1e300, -2, 3);
    theRecord(op::glVertex3d, [](Args& in) {
        EXPECT_EQ(in.get<GLdouble>(), 1e300);
        EXPECT_EQ(in.get<GLdouble>(), -2);
        EXPECT_EQ(in.get<GLdouble>(), 3);
    });
    encode_glWaitSync(t_, reinterpret_cast<GLsync>(uintptr_t{0x123456789a}), 5, ~uint64_t{0});
    theRecord(op::glWaitSync, [](Args& in) {
        EXPECT_EQ(in.get<uint64_t>(), 0x123456789au);
        EXPECT_EQ(in.get<GLbitfield>(), 5u);
        EXPECT_EQ(in.get<GLuint64>(), ~uint64_t{0});
    });
}

TEST_F(EncoderTest, padsFixedArraysToWords) {
    const GLubyte colour[3] = {1, 2, 3};
    encode_glColor3ubv(t_, colour);
    theRecord(op::glColor3ubv, [&](Args& in) { EXPECT_EQ(std::memcmp(in.fixed<GLubyte>(3), colour, 3), 0); });
    const GLdouble position[2] = {0.25, -7};
    encode_glRasterPos2dv(t_, position);
    theRecord(op::glRasterPos2dv, [&](Args& in) { EXPECT_EQ(std::memcmp(in.fixed<GLdouble>(16), position, 16), 0); });
}

TEST_F(EncoderTest, encodesInlineDataOfEveryLengthModuloFour) {
    for (const size_t n : {1u, 2u, 3u, 4u, 5u, 1000u, record::kInlineBytes - 1, record::kInlineBytes}) {
        const auto bytes = counting(n);
        encode_glBufferData(t_, GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(n), DataArg::of(bytes.data(), n),
                            GL_STATIC_DRAW);
        theRecord(op::glBufferData, [&](Args& in) {
            EXPECT_EQ(in.get<GLenum>(), GLenum{GL_ARRAY_BUFFER});
            EXPECT_EQ(in.get<GLsizeiptr>(), static_cast<GLsizeiptr>(n));
            EXPECT_EQ(copyOf(in.data()), bytes);
            EXPECT_EQ(in.get<GLenum>(), GLenum{GL_STATIC_DRAW});
        });
    }
}

TEST_F(EncoderTest, encodesNullAndOffsets) {
    encode_glBufferData(t_, GL_ARRAY_BUFFER, 64, DataArg::of(nullptr, 64), GL_STATIC_DRAW);
    theRecord(op::glBufferData, [](Args& in) {
        in.get<GLenum>();
        in.get<GLsizeiptr>();
        EXPECT_TRUE(in.data().absent());
        in.get<GLenum>();
    });
    encode_glDrawElements(t_, GL_TRIANGLES, 3, GL_UNSIGNED_INT,
                          DataArg::offset(reinterpret_cast<const void*>(uintptr_t{0x1234567890})));
    theRecord(op::glDrawElements, [](Args& in) {
        in.get<GLenum>();
        in.get<GLsizei>();
        in.get<GLenum>();
        const Data d = in.data();
        EXPECT_TRUE(d.isOffset());
        EXPECT_EQ(reinterpret_cast<uint64_t>(d.pointer()), 0x1234567890u);
    });
}

TEST_F(EncoderTest, rejectsAnOffsetWhereOnlyBytesAreValid) {
    encode_glDeleteTextures(t_, 1, DataArg::offset(reinterpret_cast<const void*>(uintptr_t{64})));
    const auto bytes = harness_.takeBytes();
    RecordReader reader(bytes);
    ReadRecord r;
    ASSERT_TRUE(reader.next(r));
    Args in(r.arguments, reader);
    in.get<GLsizei>();
    EXPECT_TRUE(in.values().absent());
    EXPECT_FALSE(in.ok());
}

TEST_F(EncoderTest, sendsLargeValuesInAdvanceInPieces) {
    for (const size_t n : {size_t{record::kInlineBytes} + 1, size_t{record::kBlobPieceBytes},
                           size_t{3} * record::kBlobPieceBytes + 5, size_t{2} << 20}) {
        const auto bytes = counting(n);
        encode_glBufferData(t_, GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(n), DataArg::of(bytes.data(), n),
                            GL_STATIC_DRAW);
        theRecord(op::glBufferData, [&](Args& in) {
            in.get<GLenum>();
            in.get<GLsizeiptr>();
            EXPECT_EQ(copyOf(in.data()), bytes);
            in.get<GLenum>();
        });
    }
}

TEST_F(EncoderTest, keepsTheOrderOfBlobsOfOneRecord) {
    const auto first = counting(20000), second = counting(30001);
    encode_glMultiDrawElements(t_, GL_LINES, DataArg::of(first.data(), first.size()), GL_UNSIGNED_INT,
                               DataArg::of(second.data(), second.size()), 5000);
    theRecord(op::glMultiDrawElements, [&](Args& in) {
        in.get<GLenum>();
        EXPECT_EQ(copyOf(in.data()), first);
        in.get<GLenum>();
        EXPECT_EQ(copyOf(in.data()), second);
        in.get<GLsizei>();
    });
}

TEST_F(EncoderTest, encodesStrings) {
    encode_glBindAttribLocation(t_, 3, 1, DataArg::text("in_position"));
    theRecord(op::glBindAttribLocation, [](Args& in) {
        in.get<GLuint>();
        in.get<GLuint>();
        const Data text = in.data();
        EXPECT_TRUE(text.isText());
        EXPECT_STREQ(text.as<char>(), "in_position");
    });
    const char* texts[] = {"#version 330\n", "", "void main() {}"};
    const GLint lengths[] = {-1, 0, 4};
    encode_glShaderSource(t_, 9, 3, packStrings(t_, 3, texts, lengths));
    theRecord(op::glShaderSource, [&](Args& in) {
        in.get<GLuint>();
        const auto count = in.get<GLsizei>();
        StringList list;
        ASSERT_TRUE(list.parse(in.data(), count));
        ASSERT_EQ(list.count(), 3u);
        EXPECT_STREQ(list.pointers()[0], "#version 330\n");
        EXPECT_STREQ(list.pointers()[1], "");
        EXPECT_STREQ(list.pointers()[2], "void");
    });
}

TEST_F(EncoderTest, packsImagesWithoutPadding) {
    // Rows of 5 bytes have a stride of 8 under the default alignment of 4.
    const auto image = counting(8 * 3);
    encode_glTexImage2D(t_, GL_TEXTURE_2D, 0, GL_R8, 5, 3, 0, GL_RED, GL_UNSIGNED_BYTE,
                        imageSource(t_, image.data(), GL_RED, GL_UNSIGNED_BYTE, 5, 3, 1, 2));
    theRecord(op::glTexImage2D, [&](Args& in) {
        for (int i = 0; i < 8; ++i) in.get<uint32_t>();
        const auto rows = copyOf(in.data());
        ASSERT_EQ(rows.size(), 15u);
        for (size_t y = 0; y < 3; ++y) EXPECT_EQ(std::memcmp(rows.data() + 5 * y, image.data() + 8 * y, 5), 0);
    });
    harness_.bindUnpackBuffer(true);
    EXPECT_TRUE(imageSource(t_, image.data(), GL_RED, GL_UNSIGNED_BYTE, 5, 3, 1, 2).isOffset);
    EXPECT_TRUE(packedSource(t_, image.data(), 24).isOffset);
}

TEST_F(EncoderTest, usesTheLongFormForLongRecords) {
    std::vector<std::vector<std::byte>> spans;
    std::vector<DataArg> data;
    for (size_t i = 0; i < 10; ++i) {
        spans.push_back(counting(record::kInlineBytes - i));
        data.push_back(DataArg::of(spans.back().data(), spans.back().size()));
    }
    const client_arrays::ArrayRecord array{0, 4, GL_FLOAT, 0, 16, 0, 0, 0, 10};
    records::clientArrays(t_, &array, 1, data.data(), 10); // about 160 KiB: fits the short form's 256 KiB
    theRecord(wire::kOpClientArrays, [&](Args& in) {
        EXPECT_EQ(in.get<uint32_t>(), 1u);
        EXPECT_EQ(in.get<uint32_t>(), 10u);
        in.fixed<client_arrays::ArrayRecord>(sizeof array);
        for (const auto& span : spans) EXPECT_EQ(copyOf(in.data()), span);
    });
    // Built by hand: the largest short record, and the smallest long one.
    for (const uint32_t words : {record::kLongForm - 1, uint32_t{record::kLongForm}}) {
        const uint32_t size = 4 * words;
        const bool isLong = words == record::kLongForm;
        ASSERT_LE(size + 8, capture::kChunkBytes + 4);
        std::byte* p = beginRecord(t_, op::glVertex3f, size);
        ASSERT_NE(p, nullptr);
        if (size + 4 > capture::kChunkBytes) continue;
        std::memset(p, 0x11, size - 4);
        endRecord(t_, p, size);
        const auto bytes = harness_.takeBytes();
        RecordReader reader(bytes);
        ReadRecord r;
        ASSERT_TRUE(reader.next(r));
        EXPECT_EQ(r.longForm, isLong);
        EXPECT_EQ(r.arguments.size(), size - 4);
    }
}

TEST_F(EncoderTest, staysWithinAChunkWithManySpans) {
    std::vector<std::vector<std::byte>> spans;
    std::vector<DataArg> data;
    std::vector<client_arrays::ArrayRecord> arrays;
    for (uint32_t i = 0; i < client_arrays::kSlots; ++i) {
        spans.push_back(counting(record::kInlineBytes - i));
        data.push_back(DataArg::of(spans.back().data(), spans.back().size()));
        arrays.push_back({i, 4, GL_FLOAT, 0, 16, i, 0, 0, 10});
    }
    records::clientArrays(t_, arrays.data(), client_arrays::kSlots, data.data(), client_arrays::kSlots);
    theRecord(wire::kOpClientArrays, [&](Args& in) {
        EXPECT_EQ(in.get<uint32_t>(), client_arrays::kSlots);
        EXPECT_EQ(in.get<uint32_t>(), client_arrays::kSlots);
        in.fixed<client_arrays::ArrayRecord>(arrays.size() * sizeof arrays[0]);
        for (const auto& span : spans) EXPECT_EQ(copyOf(in.data()), span);
    });
}

TEST_F(EncoderTest, encodesControlRecords) {
    wire::WindowConfig config{};
    config.width = 640;
    config.nativeHigh = 3;
    records::createContext(t_, {1, 2, 0, 3, 1, 4, 5, config});
    theRecord(wire::kOpCreateContext, [](Args& in) {
        for (const uint32_t v : {1, 2, 0, 3, 1, 4, 5}) EXPECT_EQ(in.get<uint32_t>(), v);
        const auto* c = in.fixed<wire::WindowConfig>(sizeof(wire::WindowConfig));
        ASSERT_NE(c, nullptr);
        EXPECT_EQ(c->width, 640u);
        EXPECT_EQ(c->nativeHigh, 3u);
    });
    records::requestTexImage(t_, 1, 0, 7, -1, 8, 9, uint64_t{1} << 40);
    theRecord(wire::kOpRequestTexImage, [](Args& in) {
        for (const uint32_t v : {1, 0, 7, -1, 8, 9}) EXPECT_EQ(in.get<uint32_t>(), v);
        EXPECT_EQ(in.get<uint64_t>(), uint64_t{1} << 40);
    });
    const auto pixels = counting(20000);
    records::fillWindow(t_, -1, 2, 100, 50, GL_COLOR_BUFFER_BIT, DataArg::of(pixels.data(), pixels.size()));
    theRecord(wire::kOpFillWindow, [&](Args& in) {
        for (const uint32_t v : {uint32_t(-1), 2u, 100u, 50u, uint32_t{GL_COLOR_BUFFER_BIT}})
            EXPECT_EQ(in.get<uint32_t>(), v);
        EXPECT_EQ(copyOf(in.data()), pixels);
    });
}

TEST_F(EncoderTest, keepsRecordsWithinChunks) {
    for (int i = 0; i < 100000; ++i) encode_glVertex3f(t_, static_cast<GLfloat>(i), 0, 0);
    const auto packets = harness_.takePackets();
    EXPECT_GT(packets.size(), 1u);
    EXPECT_EQ(packets.size(), harness_.chunksTaken());
    int next = 0;
    for (const auto& packet : packets) {
        RecordReader reader(packet);
        for (ReadRecord r; reader.next(r); ++next) {
            Args in(r.arguments, reader);
            ASSERT_EQ(in.get<GLfloat>(), static_cast<GLfloat>(next));
        }
        EXPECT_FALSE(reader.broken());
    }
    EXPECT_EQ(next, 100000);
}

TEST_F(EncoderTest, writesNothingWithoutAHead) {
    encode_glVertex3f(t_, 1, 2, 3);
    harness_.loseHead();
    t_.limit = nullptr;
    encode_glVertex3f(t_, 1, 2, 3);
    EXPECT_EQ(t_.cursor, nullptr);
    EXPECT_TRUE(t_.drawLocally);
}

} // namespace
} // namespace mural::testing
