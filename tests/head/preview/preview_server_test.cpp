// Pictures for pages: their reduction, and the socket on which the head gives them.
#include "nodes/head/preview/preview_server.hpp"

#include <algorithm>
#include <cstring>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "nodes/output/reduce_picture.hpp"
#include "tests/temporary_folder.hpp"

namespace mural {
namespace {

OwnedPicture gradient(int width, int height) {
    OwnedPicture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < 4; ++channel)
                picture.row(y)[4 * x + channel] = static_cast<std::byte>(x * 7 + y * 3 + channel);
    return picture;
}

TEST(ReducedSize, keepsProportionsAndNeverEnlarges) {
    const auto of = [](int width, int height, int maxWidth, int maxHeight) {
        const ReducedSize size = reducedSize(width, height, maxWidth, maxHeight);
        return std::pair(size.width, size.height);
    };
    EXPECT_EQ(of(1920, 1080, 1280, 1280), std::pair(1280, 720));
    EXPECT_EQ(of(1080, 1920, 320, 320), std::pair(180, 320));
    EXPECT_EQ(of(100, 50, 320, 320), std::pair(100, 50));
    EXPECT_EQ(of(32768, 1, 320, 320), std::pair(320, 1));
    EXPECT_EQ(of(0, 5, 320, 320), std::pair(0, 0));
}

TEST(ReducePicture, copiesAtFullSize) {
    const OwnedPicture source = gradient(13, 7);
    OwnedPicture target(13, 7);
    reducePicture(source.view(), {13, 7}, target.data());
    EXPECT_EQ(std::memcmp(target.data(), source.view().bgra, source.view().sizeBytes()), 0);
}

TEST(ReducePicture, pixelsAreMeansOfWhatTheyCover) {
    const OwnedPicture source = gradient(20, 12);
    OwnedPicture target(5, 4); // 4 x 3 pixels each
    reducePicture(source.view(), {5, 4}, target.data());
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x) {
            int sum = 0;
            for (int row = 3 * y; row < 3 * y + 3; ++row)
                for (int column = 4 * x; column < 4 * x + 4; ++column)
                    sum += static_cast<int>(source.view().row(row)[4 * column + 2]);
            EXPECT_EQ(static_cast<int>(target.row(y)[4 * x + 2]), (sum + 6) / 12);
        }
    }
}

TEST(ReducePicture, unevenSizesKeepConstantColours) {
    OwnedPicture source(101, 37);
    std::fill_n(source.data(), source.view().sizeBytes(), std::byte{200});
    OwnedPicture target(64, 23);
    reducePicture(source.view(), {64, 23}, target.data());
    EXPECT_TRUE(std::all_of(target.data(), target.data() + target.view().sizeBytes(),
                            [](std::byte value) { return value == std::byte{200}; }));
}

class PreviewServerTest : public ::testing::Test {
protected:
    void SetUp() override {
        auto started = PreviewServer::start(path_, [](int node) {
            return node == 0 ? std::optional(Viewport{0, 0, 0.5, 1}) : std::nullopt;
        });
        ASSERT_TRUE(started.ok());
        server_ = std::move(*started);
        connectPage();
    }

    void connectPage() {
        page_ = FileDescriptor(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path_.data(), path_.size());
        ASSERT_EQ(connect(page_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    }

    // Sends a wish with memory of that size; 0: without memory.
    void wish(const PictureWish& wish, size_t bytes, unsigned seals = F_SEAL_SHRINK) {
        iovec part{const_cast<PictureWish*>(&wish), sizeof wish};
        alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
        msghdr message{};
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        FileDescriptor memory;
        if (bytes > 0) {
            memory = FileDescriptor(memfd_create("test", MFD_ALLOW_SEALING));
            ASSERT_EQ(ftruncate(memory.get(), static_cast<off_t>(bytes)), 0);
            if (seals != 0) {
                ASSERT_EQ(fcntl(memory.get(), F_ADD_SEALS, seals), 0);
            }
            memory_ = static_cast<std::byte*>(mmap(nullptr, bytes, PROT_READ, MAP_SHARED, memory.get(), 0));
            message.msg_control = control;
            message.msg_controllen = sizeof control;
            cmsghdr* header = CMSG_FIRSTHDR(&message);
            header->cmsg_level = SOL_SOCKET;
            header->cmsg_type = SCM_RIGHTS;
            header->cmsg_len = CMSG_LEN(sizeof(int));
            const int fd = memory.get();
            std::memcpy(CMSG_DATA(header), &fd, sizeof fd);
        }
        ASSERT_EQ(sendmsg(page_.get(), &message, MSG_NOSIGNAL), static_cast<ssize_t>(sizeof wish));
    }

    // Returns the notice; nullopt: none in time, or the connection is closed.
    std::optional<PictureNotice> notice(int timeoutMs) {
        pollfd entry{page_.get(), POLLIN, 0};
        PictureNotice result;
        if (poll(&entry, 1, timeoutMs) <= 0) return std::nullopt;
        if (recv(page_.get(), &result, sizeof result, 0) != static_cast<ssize_t>(sizeof result)) return std::nullopt;
        return result;
    }

    const test::TemporaryFolder folder_;
    const std::string path_ = folder_.path() + "/pictures";
    std::unique_ptr<PreviewServer> server_;
    FileDescriptor page_;
    const std::byte* memory_ = nullptr;
};

constexpr int kSoonMs = 10'000, kQuietMs = 100;

TEST_F(PreviewServerTest, givesTheLatestPictureOnce) {
    const auto picture = std::make_shared<const OwnedPicture>(gradient(40, 20));
    server_->offer(7, picture);
    wish({kPictureWishVersion, kWallPicture, 100, 100, 0}, 40 * 20 * 4);
    const auto first = notice(kSoonMs);
    ASSERT_TRUE(first.has_value());
    EXPECT_EQ(first->outcome, PictureOutcome::Written);
    EXPECT_EQ(first->frame, 7U);
    EXPECT_EQ(std::memcmp(memory_, picture->view().bgra, 40 * 20 * 4), 0);
    wish({kPictureWishVersion, kWallPicture, 100, 100, 7}, 0);
    EXPECT_FALSE(notice(kQuietMs).has_value());
    server_->offer(9, picture); // frames in between have no effect
    EXPECT_EQ(notice(kSoonMs)->frame, 9U);
}

TEST_F(PreviewServerTest, givesThePartOfANode) {
    server_->offer(1, std::make_shared<const OwnedPicture>(gradient(40, 20)));
    wish({kPictureWishVersion, 1, 100, 100, 0}, 40 * 20 * 4);
    const auto part = notice(kSoonMs);
    ASSERT_TRUE(part.has_value());
    EXPECT_EQ(part->width, 20U);
    EXPECT_EQ(part->height, 20U);
    wish({kPictureWishVersion, 2, 100, 100, 0}, 0);
    EXPECT_EQ(notice(kSoonMs)->outcome, PictureOutcome::NoSuchSource);
}

TEST_F(PreviewServerTest, namesTheMemoryThatItNeeds) {
    server_->offer(1, std::make_shared<const OwnedPicture>(gradient(40, 20)));
    wish({kPictureWishVersion, kWallPicture, 100, 100, 0}, 100);
    const auto small = notice(kSoonMs);
    ASSERT_TRUE(small.has_value());
    EXPECT_EQ(small->outcome, PictureOutcome::NeedsMemory);
    EXPECT_EQ(small->bytes, 40U * 20 * 4);
}

TEST_F(PreviewServerTest, usesNoMemoryThatMayShrink) {
    server_->offer(1, std::make_shared<const OwnedPicture>(gradient(40, 20)));
    wish({kPictureWishVersion, kWallPicture, 100, 100, 0}, 40 * 20 * 4, 0);
    EXPECT_EQ(notice(kSoonMs)->outcome, PictureOutcome::NeedsMemory);
}

TEST_F(PreviewServerTest, closesAfterAnInvalidWish) {
    server_->offer(1, std::make_shared<const OwnedPicture>(gradient(4, 2)));
    for (const PictureWish& wrong : {PictureWish{kPictureWishVersion + 1, kWallPicture, 1, 1, 0},
                                     PictureWish{kPictureWishVersion, kWallPicture, 0, 1, 0},
                                     PictureWish{kPictureWishVersion, kWallPicture, 1, UINT32_MAX, 0}}) {
        wish(wrong, 4096);
        EXPECT_FALSE(notice(kSoonMs).has_value());
        connectPage();
    }
    ASSERT_EQ(send(page_.get(), "x", 1, MSG_NOSIGNAL), 1);
    EXPECT_FALSE(notice(kSoonMs).has_value());
}

} // namespace
} // namespace mural
