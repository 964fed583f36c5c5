#include "interposer/window_size.hpp"

#include "interposer/context.hpp"
#include "interposer/fronts/own_functions.hpp"

namespace mural {

bool askWindowSize(const Window& w, uint32_t& width, uint32_t& height) {
    return w.isEgl ? askEglSize(w, width, height) : askGlxSize(w, width, height);
}

} // namespace mural
