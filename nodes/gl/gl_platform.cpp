#include "nodes/gl/gl_platform.hpp"

#include "nodes/gl/backends.hpp"

namespace mural::gl {

Result<std::unique_ptr<Image>> Platform::createImage(const ImageSource&) {
    return Error{describe() + " has no images: use --gl egl"};
}

Result<std::unique_ptr<SharedReader>> Platform::createReader(const ContextConfig&, Context&) {
    return Error{describe() + " uses all its contexts in one thread: use --gl egl"};
}

Result<std::unique_ptr<Platform>> openPlatform(const std::string& name, const GpuChoice& choice) {
    if (name == "egl") return openEgl(choice);
    if (name == "osmesa") return openOsmesa();
    if (name == "glx") return openGlx();
    if (name != "auto") return Error{"unknown GL backend '" + name + "': use auto, egl, osmesa or glx"};
    auto egl = openEgl(choice);
    if (egl || !choice.name.empty()) return egl;
    auto osmesa = openOsmesa();
    if (osmesa) return osmesa;
    return Error{"no GL backend works: EGL: " + egl.error().message + "; OSMesa: " + osmesa.error().message};
}

} // namespace mural::gl
