// Window-system extensions that are hidden from programs although all of their commands exist, with the reasons.
#pragma once

namespace mural {

struct LocalExtension {
    const char* name;
    const char* why;
};

// The driver does not swap, so programs would wait for its swap counts and events forever.
inline constexpr LocalExtension kLocalWindowExtensions[] = {
    {"GLX_MESA_copy_sub_buffer", "parts of pictures are not shown"},
    {"EGL_NV_post_sub_buffer", "parts of pictures are not shown"},
    {"EGL_NOK_swap_region", "parts of pictures are not shown"},
    {"EGL_NOK_swap_region2", "parts of pictures are not shown"},
    {"GLX_INTEL_swap_event", "the driver's own swaps do not happen"},
    {"GLX_OML_sync_control", "the driver's own swaps do not happen"},
    {"EGL_KHR_image", "pixmaps of other programs exist on one machine only"},
    {"EGL_KHR_image_pixmap", "pixmaps of other programs exist on one machine only"},
    {"EGL_EXT_image_dma_buf_import", "external memory exists on one machine only"},
    {"EGL_EXT_image_dma_buf_import_modifiers", "external memory exists on one machine only"},
    {"EGL_MESA_image_dma_buf_export", "external memory exists on one machine only"},
    {"EGL_MESA_drm_image", "external memory exists on one machine only"},
    {"EGL_WL_bind_wayland_display", "Wayland windows are not carried"},
    {"EGL_WL_create_wayland_buffer_from_image", "Wayland windows are not carried"},
    {"EGL_KHR_cl_event2", "OpenCL events exist on one machine only"},
};

} // namespace mural
