// Encoding of node announcements.
#include "transport/discovery/announcement.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

Announcement example() {
    Announcement a{AnnouncementKind::Here, 4278, {}, "wall1", "0.1.0"};
    a.uuid[0] = std::byte{0xab};
    return a;
}

TEST(Announcement, decodesItsOwnEncoding) {
    const auto a = decodeAnnouncement(encode(example()));
    ASSERT_TRUE(a);
    EXPECT_EQ(a->kind, AnnouncementKind::Here);
    EXPECT_EQ(a->port, 4278);
    EXPECT_EQ(a->uuid, example().uuid);
    EXPECT_EQ(a->name, "wall1");
    EXPECT_EQ(a->version, "0.1.0");
}

TEST(Announcement, truncatesLongTexts) {
    Announcement a = example();
    a.name = std::string(200, 'x');
    EXPECT_EQ(decodeAnnouncement(encode(a))->name, std::string(kMaxAnnouncedText, 'x'));
}

TEST(Announcement, rejectsTruncatedAndLongerDatagrams) {
    auto bytes = encode(example());
    for (size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(decodeAnnouncement(std::span(bytes).first(size))) << size;
    bytes.push_back(std::byte{0});
    EXPECT_FALSE(decodeAnnouncement(bytes));
}

// Names are printed on terminals, so control characters are invalid.
TEST(Announcement, rejectsOtherVersionsKindsAndTexts) {
    const auto changed = [](size_t at, uint8_t value) {
        auto bytes = encode(example());
        bytes[at] = std::byte{value};
        return decodeAnnouncement(bytes).has_value();
    };
    EXPECT_TRUE(changed(29, 'v'));
    EXPECT_FALSE(changed(0, 'm'));
    EXPECT_FALSE(changed(7, 2));
    EXPECT_FALSE(changed(8, 0));
    EXPECT_FALSE(changed(8, 4));
    EXPECT_FALSE(changed(29, 0x1b));
    EXPECT_FALSE(changed(29, 0xc3));
    Announcement nowhere = example();
    nowhere.port = 0;
    EXPECT_FALSE(decodeAnnouncement(encode(nowhere)));
}

TEST(Uuid, convertsToTextAndBack) {
    const auto uuid = uuidFromText("01234567-89ab-cdef-0123-456789ABCDEF");
    ASSERT_TRUE(uuid);
    EXPECT_EQ(uuidText(*uuid), "01234567-89ab-cdef-0123-456789abcdef");
    EXPECT_EQ(uuidText(markedUuid(*uuid)), "01234567-89ab-8def-8123-456789abcdef");
    EXPECT_FALSE(uuidFromText("01234567-89ab-cdef-0123-456789abcde"));
    EXPECT_FALSE(uuidFromText("01234567x89ab-cdef-0123-456789abcdef"));
    EXPECT_FALSE(uuidFromText("0123456g-89ab-cdef-0123-456789abcdef"));
}

} // namespace
} // namespace mural
