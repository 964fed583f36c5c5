// Owning handles for libfabric objects, and texts of its error codes.
#pragma once

#include <memory>
#include <rdma/fabric.h>
#include <rdma/fi_errno.h>
#include <string>

namespace mural::fabric {

struct CloseFid {
    template <class Object> void operator()(Object* object) const { fi_close(&object->fid); }
};
template <class Object> using Handle = std::unique_ptr<Object, CloseFid>;

struct FreeInfo {
    void operator()(fi_info* info) const { fi_freeinfo(info); }
};
using Info = std::unique_ptr<fi_info, FreeInfo>;

// Shared by all connections of a listener.
using SharedFabric = std::shared_ptr<fid_fabric>;

// code: positive, or negative as returned by functions.
inline std::string codeText(long code) { return fi_strerror(static_cast<int>(code < 0 ? -code : code)); }

} // namespace mural::fabric
