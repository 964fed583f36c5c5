#include "nodes/output/windows/shared_pixels.hpp"

#include <sys/mman.h>
#include <unistd.h>

namespace mural {

namespace {

bool serverTakesDescriptors(XConnection& x, Deadline deadline) {
    if (!x.isLocal()) return false;
    const xcb_query_extension_reply_t* extension = xcb_get_extension_data(x.get(), &xcb_shm_id);
    if (extension == nullptr || extension->present == 0) return false;
    XOwned<xcb_shm_query_version_reply_t> version;
    const auto request = xcb_shm_query_version(x.get());
    if (x.await(request.sequence, deadline, &version) != XAnswer::Reply) return false;
    return version->major_version > 1 || (version->major_version == 1 && version->minor_version >= 2);
}

} // namespace

std::unique_ptr<SharedPixels> SharedPixels::attach(XConnection& x, size_t sizeBytes, Deadline deadline) {
    if (!serverTakesDescriptors(x, deadline)) return nullptr;
    const int fd = ::memfd_create("mural-window", MFD_CLOEXEC);
    if (fd < 0) return nullptr;
    void* mapping = MAP_FAILED;
    if (::ftruncate(fd, static_cast<off_t>(sizeBytes)) == 0)
        mapping = ::mmap(nullptr, sizeBytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (mapping == MAP_FAILED) {
        ::close(fd);
        return nullptr;
    }
    std::unique_ptr<SharedPixels> pixels(new SharedPixels(x, static_cast<std::byte*>(mapping), sizeBytes));
    const xcb_shm_seg_t segment = xcb_generate_id(x.get());
    // xcb closes the descriptor. A forwarded connection loses it, which returns an X error.
    const auto request = xcb_shm_attach_fd_checked(x.get(), segment, fd, 1);
    XOwned<xcb_generic_error_t> error;
    if (x.check(request, deadline, error) != XAnswer::Reply || error != nullptr) return nullptr;
    pixels->segment_ = segment;
    return pixels;
}

SharedPixels::~SharedPixels() {
    if (segment_ != 0) xcb_shm_detach(x_.get(), segment_);
    ::munmap(data_, sizeBytes_);
}

} // namespace mural
