// The fields of the geometry types of common/.
#pragma once

#include "common/geometry/eye.hpp"
#include "common/geometry/frustum.hpp"
#include "common/geometry/matrix4.hpp"
#include "common/geometry/pixel_kernel.hpp"
#include "common/geometry/pixel_viewport.hpp"
#include "common/geometry/range.hpp"
#include "common/geometry/sub_pixel.hpp"
#include "common/geometry/vector3.hpp"
#include "common/geometry/viewport.hpp"
#include "common/geometry/zoom.hpp"

namespace mural {

template <class Visit> void fields(Visit& visit, Frustum& f) {
    visit(f.left, f.right, f.bottom, f.top, f.nearPlane, f.farPlane);
}
template <class Visit> void fields(Visit& visit, Matrix4& matrix) { visit(matrix.m); }
template <class Visit> void fields(Visit& visit, PixelKernel& k) { visit(k.x, k.y, k.w, k.h); }
template <class Visit> void fields(Visit& visit, PixelViewport& v) { visit(v.x, v.y, v.w, v.h); }
template <class Visit> void fields(Visit& visit, Range& range) { visit(range.start, range.end); }
template <class Visit> void fields(Visit& visit, SubPixel& s) { visit(s.index, s.size); }
template <class Visit> void fields(Visit& visit, Vector3& v) { visit(v.x, v.y, v.z); }
template <class Visit> void fields(Visit& visit, Viewport& v) { visit(v.x, v.y, v.w, v.h); }
template <class Visit> void fields(Visit& visit, Zoom& zoom) { visit(zoom.x, zoom.y); }

} // namespace mural
