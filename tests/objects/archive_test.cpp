#include <gtest/gtest.h>

#include "tests/objects/test_types.hpp"

namespace mural::test {
namespace {

using archive::EncodedSlots;

// The blobs of one encoding.
class Blobs : public archive::BlobSource {
public:
    explicit Blobs(const EncodedSlots& slots) : blobs_(slots.encoder.blobs()) {}
    [[nodiscard]] const Blob* find(const BlobName& name) const override {
        for (const Blob& blob : blobs_)
            if (blob.name() == name) return &blob;
        return nullptr;
    }

private:
    std::vector<Blob> blobs_;
};

template <class T> Result<T> decoded(const EncodedSlots& slots) {
    T object{};
    const Blobs blobs(slots);
    const auto result =
        archive::decodeSlots(object, UINT64_MAX, &blobs, [&](uint32_t slot) { return slots.bytesOf(slot); });
    if (!result) return result.error();
    return object;
}

template <class T> T throughBytes(const T& object) {
    EncodedSlots slots;
    archive::encodeSlots(object, slots);
    auto result = decoded<T>(slots);
    EXPECT_TRUE(result) << result.error().message;
    return result ? result.value() : T{};
}

template <class T> std::string fieldError(std::vector<std::byte> bytes) {
    T object{};
    const auto result =
        archive::decodeSlots(object, 1, nullptr, [&](uint32_t) { return std::span(std::as_const(bytes)); });
    return result ? "" : result.error().message;
}

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
    std::vector<std::byte> bytes;
    for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
    return bytes;
}

TEST(Archive, restoresEveryKindOfField) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 200; ++i) {
        Everything object = randomEverything(random);
        object.mesh = Blob::copyOf(std::as_bytes(std::span(object.samples))).value();
        EXPECT_TRUE(throughBytes(object) == object) << i;
    }
}

TEST(Archive, restoresTypesWithoutFieldsOfTheirOwn) {
    EXPECT_EQ(throughBytes(2.5), 2.5);
    EXPECT_EQ(throughBytes(std::vector<float>{1, 2, 3}), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(throughBytes(std::string("text")), "text");
}

TEST(Archive, writesLittleEndianWithoutPadding) {
    EncodedSlots slots;
    archive::encodeSlots(Material{"ab", Shade::Smooth}, slots);
    ASSERT_EQ(slots.count, 2U);
    EXPECT_EQ(std::vector(slots.bytesOf(0).begin(), slots.bytesOf(0).end()), bytesOf({2, 0, 0, 0, 'a', 'b'}));
    EXPECT_EQ(std::vector(slots.bytesOf(1).begin(), slots.bytesOf(1).end()), bytesOf({0x84, 3}));
}

TEST(Archive, encodesOneFieldLikeItsSlot) {
    std::mt19937_64 random(2);
    const Everything object = randomEverything(random);
    EncodedSlots slots;
    archive::encodeSlots(object, slots);
    EXPECT_EQ(slots.count, archive::layoutOf<Everything>().fieldCount);
    for (uint32_t field = 0; field < slots.count; ++field) {
        archive::Encoder encoder;
        archive::encodeField(object, field, encoder);
        EXPECT_TRUE(std::ranges::equal(encoder.out().bytes(), slots.bytesOf(field))) << field;
    }
}

TEST(Archive, decodesOnlyTheGivenSlots) {
    EncodedSlots slots;
    archive::encodeSlots(Material{"new", Shade::Smooth}, slots);
    Material object{"old", Shade::Flat};
    ASSERT_TRUE(archive::decodeSlots(object, 2, nullptr, [&](uint32_t slot) { return slots.bytesOf(slot); }));
    EXPECT_EQ(object, (Material{"old", Shade::Smooth}));
}

struct Long {
    std::array<int32_t, 70> numbers{};
    template <class Visit> void fields(Visit& visit) {
        for (int32_t& number : numbers) visit(number);
    }
};

TEST(Archive, sharesTheLastSlotFromField64On) {
    Long object;
    for (size_t i = 0; i < object.numbers.size(); ++i) object.numbers[i] = static_cast<int32_t>(i * i);
    EncodedSlots slots;
    archive::encodeSlots(object, slots);
    EXPECT_EQ(slots.count, 64U);
    EXPECT_EQ(slots.bytesOf(62).size(), 4U);
    EXPECT_EQ(slots.bytesOf(63).size(), 7 * 4U);
    EXPECT_EQ(throughBytes(object).numbers, object.numbers);
}

struct Point {
    double x = 0, y = 0, z = 0;
    template <class Visit> void fields(Visit& visit) { visit(x, y, z); }
};
struct ListAndNumber {
    std::vector<float> a;
    double b = 0;
    template <class Visit> void fields(Visit& visit) { visit(a, b); }
};
struct FloatAndDouble {
    float a = 0;
    double b = 0;
    template <class Visit> void fields(Visit& visit) { visit(a, b); }
};

TEST(Archive, hashesDependOnTheLayoutOnly) {
    EXPECT_EQ(archive::layoutOf<Point>().hash, archive::layoutOf<Vector3>().hash);
    EXPECT_NE(archive::layoutOf<Point>().hash, archive::layoutOf<Viewport>().hash);
    EXPECT_NE(archive::layoutOf<ListAndNumber>().hash, archive::layoutOf<std::vector<FloatAndDouble>>().hash);
    EXPECT_NE(archive::layoutOf<float>().hash, archive::layoutOf<int32_t>().hash);
    // Programs on different machines compare this value.
    EXPECT_EQ(archive::layoutOf<Tree>().text, "int32; list of itself 1 up");
    EXPECT_EQ(archive::layoutOf<Tree>().hash, archive::hashOf(std::string_view("int32; list of itself 1 up")));
}

TEST(Archive, describesLayoutsInWords) {
    EXPECT_EQ(archive::layoutOf<Light>().text, "(float64, float64, float64); float32");
    EXPECT_EQ(archive::layoutOf<Material>().text, "text; enum of uint16");
    EXPECT_EQ((archive::layoutOf<std::map<int8_t, std::optional<Blob>>>().text), "map of (int8, optional blob)");
    EXPECT_NE(archive::layoutOf<Material>().typeName.find("Material"), std::string::npos);
}

TEST(Archive, namesTheFirstDifferentField) {
    EXPECT_EQ(archive::differenceOf("text; int32", "text; int64"), "field 2 is int32 here and int64 there");
    EXPECT_EQ(archive::differenceOf("text", "text; int64"), "field 2 is missing here and int64 there");
    EXPECT_EQ(archive::differenceOf("text; bool", "text"), "field 2 is bool here and missing there");
}

TEST(Archive, rejectsDamagedFields) {
    EXPECT_EQ(fieldError<int32_t>(bytesOf({1, 2, 3})), "field 1 ends too early");
    EXPECT_EQ(fieldError<int16_t>(bytesOf({1, 2, 3})), "field 1 has more bytes than expected");
    EXPECT_EQ(fieldError<bool>(bytesOf({2})), "field 1 is neither true nor false");
    EXPECT_EQ(fieldError<std::string>(bytesOf({255, 255, 255, 255, 'a'})), "field 1 has a length beyond its end");
    EXPECT_EQ(fieldError<std::vector<double>>(bytesOf({255, 255, 255, 255, 255, 255, 255, 255})),
              "field 1 has a length beyond its end");
    EXPECT_EQ((fieldError<std::variant<bool, char>>(bytesOf({2, 0}))), "field 1 has an unknown alternative");
    EXPECT_EQ((fieldError<std::map<bool, bool>>(bytesOf({2, 0, 0, 0, 1, 0, 0, 0}))), "field 1 has keys out of order");
    EXPECT_EQ(fieldError<std::vector<std::monostate>>(bytesOf({1, 0, 0, 0, 7})),
              "field 1 has elements without contents");
}

struct Mesh {
    int32_t count = 0;
    Blob blob;
    template <class Visit> void fields(Visit& visit) { visit(count, blob); }
};

TEST(Archive, rejectsBlobsThatHaveNotArrived) {
    EncodedSlots slots;
    archive::encodeSlots(Mesh{3, Blob::copyOf(bytesOf({1, 2})).value()}, slots);
    EXPECT_EQ(slots.blobsOf(0).size(), 0U);
    EXPECT_EQ(slots.blobsOf(1).size(), 1U);
    Mesh object;
    const auto result = archive::decodeSlots(object, 3, nullptr, [&](uint32_t slot) { return slots.bytesOf(slot); });
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().message, "field 2 refers to a blob that has not arrived");
}

TEST(Archive, survivesRandomDamage) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 3000; ++i) {
        EncodedSlots slots;
        archive::encodeSlots(randomEverything(random), slots);
        const uint32_t slot = static_cast<uint32_t>(random() % slots.count);
        std::vector<std::byte> bytes(slots.bytesOf(slot).begin(), slots.bytesOf(slot).end());
        for (size_t n = 1 + random() % 3; n > 0 && !bytes.empty(); --n) {
            if (random() % 3 == 0) bytes.resize(random() % bytes.size());
            if (!bytes.empty()) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
        }
        Everything object;
        const Blobs blobs(slots);
        (void)archive::decodeSlots(object, uint64_t{1} << slot, &blobs,
                                   [&](uint32_t) { return std::span(std::as_const(bytes)); });
    }
}

} // namespace
} // namespace mural::test
