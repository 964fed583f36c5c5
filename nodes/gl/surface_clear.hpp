// Clears new surfaces, because drivers do not. The colours of Mesa's pbuffers without a window system lie in recycled
// heap memory of the process (measured, 22.3.6), which may hold other pictures.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "nodes/gl/gl_platform.hpp"

namespace mural::gl {

// Owns the contexts that clear, one per configuration. They belong to the platform, so that no state of a program can
// mask, clip or skip the clear.
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
