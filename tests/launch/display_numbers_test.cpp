// Numbers of X displays without a server, in a folder of the test.
#include "nodes/launch/display_numbers.hpp"

#include <cstddef>
#include <cstring>
#include <future>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "common/ipc/file_descriptor.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::launch {
namespace {

enum class Name { File, Abstract };

FileDescriptor listenAt(const std::string& path, Name name) {
    FileDescriptor fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const size_t at = name == Name::Abstract ? 1 : 0;
    path.copy(address.sun_path + at, sizeof address.sun_path - at - 1);
    const size_t bytes = offsetof(sockaddr_un, sun_path) + at + path.size();
    EXPECT_EQ(bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), static_cast<socklen_t>(bytes)), 0);
    EXPECT_EQ(listen(fd.get(), 1), 0);
    return fd;
}

class DisplayNumbersTest : public testing::Test {
protected:
    [[nodiscard]] std::string socketOf(int number) const { return sockets() + "/X" + std::to_string(number); }
    [[nodiscard]] std::string sockets() const { return folder_.path() + "/sockets"; }

private:
    test::TemporaryFolder folder_;
};

TEST_F(DisplayNumbersTest, createsTheFolderForAllUsers) {
    const DisplayNumbers numbers(sockets());
    struct stat made {};
    ASSERT_EQ(stat(sockets().c_str(), &made), 0);
    EXPECT_EQ(made.st_mode & 07777u, 01777u);
    EXPECT_EQ(numbers.firstFree(), 0);
    EXPECT_EQ(numbers.firstFree(7), 7);
}

TEST_F(DisplayNumbersTest, skipsServersOfOtherNetworkNamespaces) { // which have the file only
    const DisplayNumbers numbers(sockets());
    const auto server = listenAt(socketOf(0), Name::File);
    EXPECT_EQ(numbers.firstFree(), 1);
}

TEST_F(DisplayNumbersTest, skipsServersOfOtherMountNamespaces) { // which have the abstract name only
    const DisplayNumbers numbers(sockets());
    const auto server = listenAt(socketOf(0), Name::Abstract);
    EXPECT_EQ(numbers.firstFree(), 1);
}

TEST_F(DisplayNumbersTest, takesTheNumberOfAnEndedServer) {
    const DisplayNumbers numbers(sockets());
    listenAt(socketOf(0), Name::File); // closed at once; the file remains
    EXPECT_EQ(numbers.firstFree(), 0);
}

TEST_F(DisplayNumbersTest, waitsForOtherSessions) {
    auto first = std::make_unique<DisplayNumbers>(sockets());
    auto second = std::async(std::launch::async, [this] { return DisplayNumbers(sockets()).firstFree(); });
    EXPECT_EQ(second.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
    first.reset();
    EXPECT_EQ(second.get(), 0);
}

} // namespace
} // namespace mural::launch
