// The socket at which a session reports its state: place, access rights, stale files.
#include "nodes/launch/session_socket.hpp"

#include <filesystem>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <utime.h>

#include "tests/temporary_folder.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::launch {
namespace {

constexpr const char* kSession = "mural-42-0123456789abcdef";
constexpr const char* kOther = "mural-43-0123456789abcdef";

FileDescriptor listenAt(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    FileDescriptor fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    EXPECT_EQ(bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(fd.get(), 1), 0);
    return fd;
}

void makeOld(const std::string& folder) {
    const utimbuf old{1, 1};
    EXPECT_EQ(utime(folder.c_str(), &old), 0);
}

TEST(SessionSocket, isInAPrivateFolderOfItsUser) {
    const test::TemporaryFolder runtime;
    auto socket = SessionSocket::create(kSession, runtime.path());
    ASSERT_TRUE(socket.ok());
    EXPECT_EQ(socket.value()->path(), runtime.at(kSession) + "/socket");
    struct stat facts {};
    ASSERT_EQ(stat(runtime.at(kSession).c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777, 0700U);
}

TEST(SessionSocket, isGoneAtTheEnd) {
    const test::TemporaryFolder runtime;
    auto socket = SessionSocket::create(kSession, runtime.path());
    ASSERT_TRUE(socket.ok());
    const FileDescriptor listener = listenAt(socket.value()->path());
    const FileDescriptor control = listenAt(controlSocketOf(socket.value()->path()));
    socket.value().reset();
    EXPECT_FALSE(std::filesystem::exists(runtime.at(kSession)));
}

TEST(SessionSocket, isElsewhereWhenThePathIsTooLong) {
    const test::TemporaryFolder runtime;
    const std::string deep = runtime.at(std::string(100, 'x'));
    std::filesystem::create_directory(deep);
    auto socket = SessionSocket::create(kSession, deep);
    ASSERT_TRUE(socket.ok());
    EXPECT_EQ(socket.value()->path(), std::string("/tmp/") + kSession + "/socket");
}

TEST(SessionSocket, isNotCreatedWhereTheNameExists) {
    const test::TemporaryFolder runtime;
    std::filesystem::create_directory(runtime.at(kSession));
    auto socket = SessionSocket::create(kSession, runtime.path());
    ASSERT_TRUE(socket.ok()); // in the other place
    EXPECT_NE(socket.value()->path(), runtime.at(kSession) + "/socket");
}

TEST(SessionSocket, removesFoldersWithoutAListener) {
    const test::TemporaryFolder runtime;
    for (const char* session : {kSession, kOther}) std::filesystem::create_directory(runtime.at(session));
    std::filesystem::create_directory(runtime.at("mural-1-of-another-kind"));
    { const FileDescriptor dead = listenAt(runtime.at(kSession) + "/socket"); }
    const FileDescriptor alive = listenAt(runtime.at(kOther) + "/socket");
    for (const char* name : {kSession, kOther, "mural-1-of-another-kind"}) makeOld(runtime.at(name));
    removeStaleSockets(runtime.path());
    EXPECT_FALSE(std::filesystem::exists(runtime.at(kSession)));
    EXPECT_TRUE(std::filesystem::exists(runtime.at(kOther)));
    EXPECT_TRUE(std::filesystem::exists(runtime.at("mural-1-of-another-kind")));
}

TEST(SessionSocket, keepsAFolderWhoseHeadMayStillListen) {
    const test::TemporaryFolder runtime;
    std::filesystem::create_directory(runtime.at(kSession));
    removeStaleSockets(runtime.path());
    EXPECT_TRUE(std::filesystem::exists(runtime.at(kSession)));
}

} // namespace
} // namespace mural::launch
