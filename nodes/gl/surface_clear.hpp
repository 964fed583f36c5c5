// Clears surfaces that were just created. Drivers take their memory as it is: Mesa's pbuffers without a window system
// get their colours from the heap of the process (measured, 22.3.6), and with them bytes of other pictures.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

// The contexts that clear, one per configuration. They are the platform's own: nothing that a program sets can mask,
// clip or skip the clear.
class ClearingContexts {
public:
    using Create = std::function<Result<std::unique_ptr<Context>>(const ContextConfig&)>;
    // anyConfig: one context can draw to surfaces of every configuration.
    Result<Context*> find(const SurfaceConfig& bits, bool anyConfig, const Create& create);

private:
    struct Entry {
        SurfaceConfig bits;
        std::unique_ptr<Context> context;
    };
    std::vector<Entry> entries_;
};

// Sets colours, alpha, depth, stencil and accumulation of the current draw surface to 0 and waits for it.
// Precondition: a context of ClearingContexts is current with it.
void clearCurrentSurface(Platform& platform, const SurfaceConfig& bits, ColorBuffers buffers);

} // namespace mural::gl
