#include "examples/data/file_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <zlib.h>

namespace mural::examples {
namespace {

constexpr size_t kStepBytes = size_t{1} << 20;

Error tooLarge(const std::string& file, uint64_t maxBytes) {
    return Error{file + ": has more than " + std::to_string(maxBytes) + " bytes, which is the limit"};
}

// Ends zlib's state in every case.
struct Inflater {
    z_stream stream{};
    bool isReady = inflateInit2(&stream, MAX_WBITS + 16) == Z_OK; // 16: the gzip format
    Inflater() = default;
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&stream); }
};

} // namespace

bool isGzip(std::string_view bytes) { return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b'; }

Result<std::string> gunzip(std::string_view bytes, const std::string& file, uint64_t maxBytes) {
    Inflater inflater;
    if (!inflater.isReady) return Error{file + ": out of memory"};
    z_stream& stream = inflater.stream;
    std::vector<char> step(kStepBytes);
    std::string out;
    size_t taken = 0;
    while (true) {
        // zlib counts in 32 bits.
        const size_t given = std::min(bytes.size() - taken, kStepBytes);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
        stream.avail_in = static_cast<uInt>(given);
        stream.next_out = reinterpret_cast<Bytef*>(step.data());
        stream.avail_out = static_cast<uInt>(step.size());
        const int status = inflate(&stream, Z_NO_FLUSH);
        taken += given - stream.avail_in;
        const size_t made = step.size() - stream.avail_out;
        if (out.size() + made > maxBytes) return tooLarge(file, maxBytes);
        out.append(step.data(), made);
        if (status == Z_STREAM_END) {
            if (!isGzip(bytes.substr(taken))) return out; // other bytes after the last member are padding
            inflateReset(&stream);
        } else if (status != Z_OK || (given == stream.avail_in && made == 0)) {
            return Error{file + ": byte " + std::to_string(taken) + ": the compressed data are " +
                         (taken == bytes.size() ? "cut off" : "damaged")};
        }
    }
}

Result<std::string> readFile(const std::string& path, uint64_t maxBytes) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) return Error{path + ": cannot be opened: " + std::strerror(errno)};
    std::string bytes;
    std::vector<char> step(kStepBytes);
    while (const size_t got = std::fread(step.data(), 1, step.size(), file.get())) {
        if (bytes.size() + got > maxBytes) return tooLarge(path, maxBytes);
        bytes.append(step.data(), got);
    }
    if (std::ferror(file.get()) != 0) return Error{path + ": cannot be read: " + std::strerror(errno)};
    if (isGzip(bytes)) return gunzip(bytes, path, maxBytes);
    return bytes;
}

} // namespace mural::examples
