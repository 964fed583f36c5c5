// Window-system extensions that are hidden from programs although all of their commands exist, with the reasons.
#pragma once

namespace mural {

struct LocalExtension {
    const char* name;
    const char* why;
};

// The driver does not swap, so programs would wait for its swap counts and events forever.
inline constexpr LocalExtension kLocalWindowExtensions[] = {
    {"GLX_MESA_copy_sub_buffer", "partial swaps are not supported"},
    {"EGL_NV_post_sub_buffer", "partial swaps are not supported"},
    {"EGL_NOK_swap_region", "partial swaps are not supported"},
    {"EGL_NOK_swap_region2", "partial swaps are not supported"},
    {"GLX_INTEL_swap_event", "the driver does not swap"},
    {"GLX_OML_sync_control", "the driver does not swap"},
    {"EGL_KHR_image", "pixmaps of other programs exist on one machine only"},
    {"EGL_KHR_image_pixmap", "pixmaps of other programs exist on one machine only"},
    {"EGL_EXT_image_dma_buf_import", "external memory exists on one machine only"},
    {"EGL_EXT_image_dma_buf_import_modifiers", "external memory exists on one machine only"},
    {"EGL_MESA_image_dma_buf_export", "external memory exists on one machine only"},
    {"EGL_MESA_drm_image", "external memory exists on one machine only"},
    {"EGL_WL_bind_wayland_display", "Wayland is not supported"},
    {"EGL_WL_create_wayland_buffer_from_image", "Wayland is not supported"},
    {"EGL_KHR_cl_event2", "OpenCL events exist on one machine only"},
};

} // namespace mural
