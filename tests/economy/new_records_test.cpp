// When the rest of a packet goes as bytes.
#include "economy/new_records.hpp"

#include <gtest/gtest.h>

namespace mural::economy {
namespace {

// So many new records in a row are looked at before there are many.
int lookedAt(NewRecords& news) {
    int count = 0;
    for (; !news.many() && count < 1000; ++count) news.isNew();
    return count;
}

TEST(NewRecords, fewerAreLookedAtBehindEachPacketWhoseRestWasLeftOut) {
    NewRecords news;
    news.packetBegins(1, 0);
    EXPECT_EQ(lookedAt(news), 256);
    for (const int expected : {32, 16, 8, 4, 4}) {
        news.leaveOut(100);
        news.packetBegins(1, 100);
        EXPECT_EQ(lookedAt(news), expected);
    }
    news.packetBegins(1, 100); // of the one before nothing was left out
    EXPECT_EQ(lookedAt(news), 32);
}

} // namespace
} // namespace mural::economy
