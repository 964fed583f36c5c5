// Loads the libraries of the GL driver that nodes use.
#pragma once

namespace mural {

// Loads Mesa's EGL and its software rasterizer, which creates no thread and opens no device. Does nothing on machines
// with NVIDIA's kernel module: whether that driver survives a fork is not documented. Libraries that are missing are
// skipped.
void preloadDriver();

} // namespace mural
