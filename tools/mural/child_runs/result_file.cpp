#include "tools/mural/child_runs/result_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string_view>
#include <unistd.h>

namespace mural::cli {

Result<ResultFile> ResultFile::open(const std::string& option, const std::string& path) {
    ResultFile result(option, path);
    if (path.empty()) return result;
    constexpr int kFlags = O_WRONLY | O_CREAT | O_CLOEXEC;
    result.file_ = FileDescriptor(::open(path.c_str(), kFlags | O_EXCL, 0666));
    result.unused_ = result.file_.valid();
    if (!result.unused_ && errno == EEXIST) result.file_ = FileDescriptor(::open(path.c_str(), kFlags, 0666));
    if (!result.file_.valid()) return result.failed();
    return result;
}

ResultFile::~ResultFile() {
    if (unused_) unlink(path_.c_str());
}

Error ResultFile::failed() const {
    return Error{name_ + " cannot be written: " + std::strerror(errno) + "; choose another file"};
}

Result<void> ResultFile::write(const std::string& text) {
    if (path_.empty()) return {};
    unused_ = false;
    // EINVAL: a pipe or a device, which has no length
    if (ftruncate(file_.get(), 0) != 0 && errno != EINVAL) return failed();
    for (std::string_view rest = text; !rest.empty();) {
        const ssize_t n = ::write(file_.get(), rest.data(), rest.size());
        if (n < 0 && errno != EINTR) return failed();
        if (n > 0) rest.remove_prefix(static_cast<size_t>(n));
    }
    if (close(file_.release()) != 0) return failed(); // network file systems report errors at close
    return {};
}

} // namespace mural::cli
