#include "nodes/output/files/png_files.hpp"

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <png.h>

namespace mural {

namespace {

// A low level and one filter, because pictures arrive fast. A 1920x1080 picture takes 39 ms and 0.6 MB; with libpng's
// choice among all filters 93 ms and 0.7 MB; at its default level 284 ms and 0.5 MB.
constexpr int kCompressionLevel = 1;
constexpr int kFilter = PNG_FILTER_UP;
// Bounds the allocation for a corrupt header. The largest OpenGL framebuffer is smaller.
constexpr png_uint_32 kLargestPngSide = 1U << 17;
constexpr uint64_t kLargestPixels = uint64_t{1} << 30;

struct File {
    explicit File(FILE* f) : stream(f) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        if (stream != nullptr) std::fclose(stream);
    }
    FILE* stream;
};

// State of libpng's callbacks; trivial, because longjmp skips destructors.
struct Trouble {
    FILE* stream = nullptr;
    int systemError = 0;
    char text[128] = "";
};

void onError(png_structp png, png_const_charp text) {
    auto* trouble = static_cast<Trouble*>(png_get_error_ptr(png));
    std::snprintf(trouble->text, sizeof trouble->text, "%s", text);
    png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {} // harmless by definition; keeps the terminal clean

void writeBytes(png_structp png, png_bytep bytes, size_t sizeBytes) {
    auto* trouble = static_cast<Trouble*>(png_get_io_ptr(png));
    errno = 0;
    if (std::fwrite(bytes, 1, sizeBytes, trouble->stream) == sizeBytes) return;
    trouble->systemError = errno;
    png_error(png, "write failed");
}

void flushBytes(png_structp) {}

void readBytes(png_structp png, png_bytep bytes, size_t sizeBytes) {
    auto* trouble = static_cast<Trouble*>(png_get_io_ptr(png));
    errno = 0;
    if (std::fread(bytes, 1, sizeBytes, trouble->stream) == sizeBytes) return;
    trouble->systemError = errno;
    png_error(png, "the file ends too early");
}

// Row pointers from the top row down, the order of PNG.
std::vector<png_bytep> rowsFromTop(const std::byte* data, int height, size_t rowBytes) {
    std::vector<png_bytep> rows(static_cast<size_t>(height));
    for (int y = 0; y < height; ++y) {
        const std::byte* row = data + rowBytes * static_cast<size_t>(height - 1 - y);
        rows[static_cast<size_t>(y)] = reinterpret_cast<png_bytep>(const_cast<std::byte*>(row));
    }
    return rows;
}

// Between setjmp and a possible longjmp, no local object owns memory or changes.
bool encode(png_structp png, png_infop info, Trouble* trouble, int width, int height, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_write_fn(png, trouble, writeBytes, flushBytes);
    png_set_user_limits(png, kLargestPngSide, kLargestPngSide);
    png_set_compression_level(png, kCompressionLevel);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, kFilter);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_set_bgr(png);
    png_set_filler(png, 0, PNG_FILLER_AFTER); // drops A
    png_write_image(png, rows);
    png_write_end(png, info);
    return true;
}

Error cannotWrite(const std::string& path, int systemError) {
    std::string advice = "check --out";
    if (systemError == ENOSPC || systemError == EDQUOT)
        advice = "free some space, or choose another disk with --out";
    else if (systemError == EACCES || systemError == EPERM || systemError == EROFS)
        advice = "choose a folder that you may write to with --out";
    return {fmt::format("cannot write {}: {}; {}", path, std::strerror(systemError), advice)};
}

// Returns an errno value; 0: success.
int writeComplete(FILE* stream, const Picture& picture, Trouble& trouble) {
    trouble.stream = stream;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &trouble, onError, onWarning);
    if (png == nullptr) return ENOMEM;
    png_infop info = png_create_info_struct(png);
    std::vector<png_bytep> rows = rowsFromTop(picture.bgra, picture.height, picture.rowBytes());
    const bool encoded = info != nullptr && encode(png, info, &trouble, picture.width, picture.height, rows.data());
    png_destroy_write_struct(&png, &info);
    if (encoded) return 0;
    return trouble.systemError != 0 ? trouble.systemError : EINVAL;
}

// First step of reading: everything before the pixels, which then arrive as B G R A.
bool readHeader(png_structp png, png_infop info, Trouble* trouble) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_read_fn(png, trouble, readBytes);
    png_set_user_limits(png, kLargestPngSide, kLargestPngSide);
    png_read_info(png, info);
    png_set_expand(png);
    png_set_strip_16(png);
    png_set_gray_to_rgb(png);
    png_set_strip_alpha(png);
    png_set_bgr(png);
    png_set_filler(png, 0xff, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return true;
}

bool readRows(png_structp png, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_read_image(png, rows);
    png_read_end(png, nullptr);
    return true;
}

bool readPicture(png_structp png, png_infop info, Trouble& trouble, OwnedPicture& picture) {
    if (!readHeader(png, info, &trouble)) return false;
    const png_uint_32 width = png_get_image_width(png, info);
    const png_uint_32 height = png_get_image_height(png, info);
    if (uint64_t{width} * height > kLargestPixels) {
        std::snprintf(trouble.text, sizeof trouble.text, "%ux%u pixels are too many", width, height);
        return false;
    }
    picture.resize(static_cast<int>(width), static_cast<int>(height));
    std::vector<png_bytep> rows = rowsFromTop(picture.data(), picture.height(), picture.rowBytes());
    return readRows(png, rows.data());
}

} // namespace

Result<void> writePng(const std::string& path, const Picture& picture) {
    if (picture.empty()) return Error{fmt::format("cannot write {}: the picture is empty", path)};
    const std::string partPath = path + ".part";
    const int fd = ::open(partPath.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) return cannotWrite(path, errno);
    File file(::fdopen(fd, "wb"));
    if (file.stream == nullptr) {
        const int systemError = errno;
        ::close(fd);
        return cannotWrite(path, systemError);
    }
    Trouble trouble;
    int systemError = writeComplete(file.stream, picture, trouble);
    if (std::fclose(std::exchange(file.stream, nullptr)) != 0 && systemError == 0) systemError = errno;
    if (systemError == 0 && ::rename(partPath.c_str(), path.c_str()) != 0) systemError = errno;
    if (systemError == 0) return {};
    ::unlink(partPath.c_str());
    if (systemError == EINVAL && trouble.text[0] != '\0')
        return Error{fmt::format("cannot write {}: libpng: {}", path, trouble.text)};
    return cannotWrite(path, systemError);
}

Result<OwnedPicture> readPng(const std::string& path) {
    File file(std::fopen(path.c_str(), "rbe"));
    if (file.stream == nullptr) return Error{fmt::format("cannot read {}: {}", path, std::strerror(errno))};
    Trouble trouble;
    trouble.stream = file.stream;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &trouble, onError, onWarning);
    if (png == nullptr) return Error{fmt::format("cannot read {}: out of memory", path)};
    png_infop info = png_create_info_struct(png);
    OwnedPicture picture;
    const bool read = info != nullptr && readPicture(png, info, trouble, picture);
    png_destroy_read_struct(&png, &info, nullptr);
    if (read) return picture;
    if (trouble.systemError != 0)
        return Error{fmt::format("cannot read {}: {}", path, std::strerror(trouble.systemError))};
    return Error{fmt::format("cannot read {}: not a usable PNG file: {}", path, trouble.text)};
}

Result<std::unique_ptr<PngFiles>> PngFiles::open(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        return Error{
            fmt::format("cannot make the folder {}: {}; choose another one with --out", folder, error.message())};
    }
    if (!std::filesystem::is_directory(folder, error))
        return Error{fmt::format("{} is not a folder; choose another one with --out", folder)};
    if (::access(folder.c_str(), W_OK | X_OK) != 0) return cannotWrite(folder, errno);
    return std::unique_ptr<PngFiles>(new PngFiles(folder));
}

Result<void> PngFiles::show(int64_t frame, const Picture& picture) {
    const std::string name = fmt::format("frame-{:06}.png", frame);
    const std::string path = (std::filesystem::path(folder_) / name).string();
    Result<void> written = writePng(path, picture);
    if (!written) return written;
    lastPath_ = path;
    ++filesWritten_;
    return {};
}

std::string PngFiles::describe() const { return fmt::format("PNG files in {}", folder_); }

} // namespace mural
