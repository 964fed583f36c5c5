#include "tools/mural/page/access/link_store.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "common/ipc/file_descriptor.hpp"
#include "common/json/json_text.hpp"

namespace mural::page {

Result<void> keepLinks(const std::string& path, const LinkTable& links, int64_t nowNs) {
    const std::string text = jsonText(links.kept(nowNs)) + "\n";
    const std::string next = path + ".new";
    const FileDescriptor file(
        ::open(next.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR));
    const bool isWritten =
        file.valid() && write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
    if (!isWritten || std::rename(next.c_str(), path.c_str()) != 0)
        return Error{path + ": " + std::strerror(errno) + "; links end with the page"};
    return {};
}

bool restoreLinks(const std::string& path, LinkTable& links, int64_t nowNs) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return true;
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return links.restore(parseJson(text), nowNs);
}

} // namespace mural::page
