#include "nodes/gl/egl_devices.hpp"

#include <array>
#include <filesystem>
#include <system_error>

#include "nodes/gl/egl_display.hpp"

#ifndef EGL_RENDERER_EXT
#define EGL_RENDERER_EXT 0x335F // EGL_EXT_device_query_name
#endif
#ifndef EGL_DEVICE_UUID_EXT
#define EGL_DEVICE_UUID_EXT 0x335C // EGL_EXT_device_persistent_id
#endif
#ifndef EGL_DRM_RENDER_NODE_FILE_EXT
#define EGL_DRM_RENDER_NODE_FILE_EXT 0x3377 // EGL_EXT_device_drm_render_node
#endif

namespace mural::gl {
namespace {

constexpr EGLint kUuidBytes = 16;

using QueryBinary = EGLBoolean (*)(EGLDeviceEXT, EGLint name, EGLint maxBytes, void* value, EGLint* bytes);

std::string hexOf(const unsigned char* bytes, EGLint count) {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (EGLint i = 0; i < count; ++i) {
        text += kDigits[bytes[i] >> 4];
        text += kDigits[bytes[i] & 15];
    }
    return text;
}

std::string stringOf(const EglFunctions& egl, EGLDeviceEXT device, const std::string& extensions, const char* extension,
                     EGLint name) {
    if (extensions.find(extension) == std::string::npos) return {};
    const char* text = egl.queryDeviceString(device, name);
    return text ? text : "";
}

// The kernel links a DRM node to the folder of its PCI device.
std::string pciAddressOf(const std::string& drmNode) {
    const std::string node = drmNode.substr(drmNode.rfind('/') + 1);
    std::error_code error;
    const auto device = std::filesystem::read_symlink("/sys/class/drm/" + node + "/device", error);
    const std::string address = error ? std::string() : device.filename().string();
    return address.find(':') == std::string::npos ? std::string() : address;
}

} // namespace

std::vector<EglDevice> listEglDevices() {
    std::vector<EglDevice> list;
    const auto loaded = loadEgl();
    if (!loaded) return list;
    const EglFunctions& egl = loaded.value();
    std::array<EGLDeviceEXT, kMaxEglDevices> devices{};
    EGLint count = 0;
    if (!egl.queryDevices || !egl.queryDeviceString || !egl.queryDevices(kMaxEglDevices, devices.data(), &count))
        return list;
    const auto queryBinary = reinterpret_cast<QueryBinary>(egl.getProcAddress("eglQueryDeviceBinaryEXT"));
    for (EGLint i = 0; i < count; ++i) {
        const EGLDeviceEXT device = devices[static_cast<size_t>(i)];
        const char* words = egl.queryDeviceString(device, EGL_EXTENSIONS);
        const std::string extensions = words ? words : "";
        EglDevice d;
        d.name = "device " + std::to_string(i);
        d.software = extensions.find("EGL_MESA_device_software") != std::string::npos;
        d.renderer = stringOf(egl, device, extensions, "EGL_EXT_device_query_name", EGL_RENDERER_EXT);
        d.drmNode = stringOf(egl, device, extensions, "EGL_EXT_device_drm_render_node", EGL_DRM_RENDER_NODE_FILE_EXT);
        if (d.drmNode.empty())
            d.drmNode = stringOf(egl, device, extensions, "EGL_EXT_device_drm", EGL_DRM_DEVICE_FILE_EXT);
        if (!d.drmNode.empty()) d.pciAddress = pciAddressOf(d.drmNode);
        std::array<unsigned char, kUuidBytes> uuid{};
        EGLint bytes = 0;
        if (queryBinary && extensions.find("EGL_EXT_device_persistent_id") != std::string::npos &&
            queryBinary(device, EGL_DEVICE_UUID_EXT, kUuidBytes, uuid.data(), &bytes) && bytes == kUuidBytes)
            d.uuid = hexOf(uuid.data(), bytes);
        list.push_back(std::move(d));
    }
    return list;
}

} // namespace mural::gl
