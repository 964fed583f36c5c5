#include "nodes/launch/session_socket.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <dirent.h>
#include <regex>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <vector>

#include "common/ipc/file_descriptor.hpp"

namespace mural::launch {

namespace {

constexpr const char* kTemporary = "/tmp";
constexpr const char* kFileName = "/socket";
constexpr const char* kControlName = "/control";
constexpr const char* kPicturesName = "/pictures";
constexpr const char* kPageName = "/page";
constexpr time_t kMinAgeS = 10; // the head of a newer folder may not have opened its socket yet

std::string folderOf(const std::string& path) { return path.substr(0, path.rfind('/')); }

bool isOwnFolder(const std::string& path, struct stat& facts) {
    return lstat(path.c_str(), &facts) == 0 && S_ISDIR(facts.st_mode) && facts.st_uid == geteuid();
}

bool fitsSocket(const std::string& path) { return path.size() < sizeof(sockaddr_un::sun_path); }

// True if the kernel reports that no process listens.
bool isDeserted(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (!fitsSocket(path)) return false;
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    const FileDescriptor fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd.valid()) return false;
    const int result = connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
    return result != 0 && (errno == ECONNREFUSED || errno == ENOENT);
}

} // namespace

Result<std::unique_ptr<SessionSocket>> SessionSocket::create(const std::string& session,
                                                             const std::string& runtimeFolder) {
    struct stat facts {};
    std::vector<std::string> places{kTemporary};
    if (isOwnFolder(runtimeFolder, facts)) places.insert(places.begin(), runtimeFolder);
    std::string reason;
    for (const std::string& place : places) {
        const std::string folder = place + "/" + session, path = folder + kFileName;
        if (!fitsSocket(path)) continue;
        removeStaleSockets(place);
        if (mkdir(folder.c_str(), 0700) == 0) return std::unique_ptr<SessionSocket>(new SessionSocket(path));
        reason = folder + " cannot be created: " + std::strerror(errno);
    }
    return Error{reason};
}

SessionSocket::~SessionSocket() { removeSessionSocket(path_); }

std::string controlSocketOf(const std::string& sessionSocket) { return folderOf(sessionSocket) + kControlName; }

std::string pictureSocketOf(const std::string& sessionSocket) { return folderOf(sessionSocket) + kPicturesName; }

std::string pageSocketOf(const std::string& sessionSocket) { return folderOf(sessionSocket) + kPageName; }

void removeSessionSocket(const std::string& path) {
    unlink(path.c_str());
    const std::string links = folderOf(path) + "/page-links"; // a file of the page (tools/mural/page/access)
    for (const std::string& other :
         {controlSocketOf(path), pictureSocketOf(path), pageSocketOf(path), links, links + ".new"})
        unlink(other.c_str());
    rmdir(folderOf(path).c_str());
}

void removeStaleSockets(const std::string& folder) {
    static const std::regex kName("mural-[0-9]+-[0-9a-f]{16}");
    DIR* entries = opendir(folder.c_str());
    if (entries == nullptr) return;
    std::vector<std::string> found;
    while (const dirent* entry = readdir(entries))
        if (std::regex_match(entry->d_name, kName)) found.push_back(folder + "/" + entry->d_name);
    closedir(entries);
    for (const std::string& name : found) {
        struct stat facts {};
        const std::string path = name + kFileName;
        if (isOwnFolder(name, facts) && facts.st_mtime + kMinAgeS <= time(nullptr) && isDeserted(path))
            removeSessionSocket(path);
    }
}

} // namespace mural::launch
