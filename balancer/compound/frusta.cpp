#include "balancer/compound/frusta.hpp"

#include <algorithm>

namespace mural::compound {

namespace {

using config::Screen;

ViewState unitsOf(const FrameInput& input, Index view) {
    return view != kNone && at(view) < input.views.size() ? input.views[at(view)] : ViewState{};
}

// Least distance between eye and screen, in metres. An eye in the screen's plane has no valid frustum.
constexpr double kClosest = 1e-4;

struct OffAxis {
    double left, right, bottom, top;
    bool mirrored;
};

// Returns the screen's edges as seen from `eye` (in screen coordinates), on a plane at distance `scale` * eye.z.
OffAxis edgesFrom(const Screen& screen, const Vector3& eye, double scale) {
    const bool mirrored = eye.z < 0;
    const double half = screen.width / 2 * (mirrored ? -1 : 1);
    return {(-half - eye.x) * scale, (half - eye.x) * scale, (-screen.height / 2 - eye.y) * scale,
            (screen.height / 2 - eye.y) * scale, mirrored};
}

double distanceAlong(const Screen& screen, const Vector3& from, const Vector3& direction) {
    const double towards = dot(direction, screen.normal);
    return towards == 0 ? -1 : dot(screen.center - from, screen.normal) / towards;
}

// Returns the distance to the nearest screen in front of the observer: the view's own, or a segment that shows the
// view.
double focusDistanceOf(const ResolvedConfig& config, Index view, const Vector3& from, const Vector3& direction) {
    const config::ResolvedView& v = config.views[at(view)];
    if (v.surface) return distanceAlong(config::screenOf(*v.surface), from, direction);
    double nearest = -1;
    for (const config::ResolvedChannel& c : config.channels) {
        if (c.view != view) continue;
        const config::ResolvedSegment& s = config.segments[at(c.segment)];
        const double d = distanceAlong(config::screenOf(s.surface).part(s.surfacePart), from, direction);
        if (d > 0 && (nearest <= 0 || d < nearest)) nearest = d;
    }
    return nearest;
}

// Returns the factor by which the screen is moved away from the eye and enlarged. Objects at the focus distance then
// have no parallax.
double focusRatio(const ResolvedConfig& config, const FrameInput& input, Index view) {
    const Index o = config.views[at(view)].observer;
    if (o == kNone || config.observers[at(o)].focusMode == config::FocusMode::Fixed) return 1;
    const config::ResolvedObserver& observer = config.observers[at(o)];
    const Matrix4 head = at(o) < input.observers.size() ? input.observers[at(o)].head : Matrix4{};
    const Vector3 eye = transformPoint(head, observer.eyeCyclop);
    if (observer.focusMode == config::FocusMode::RelativeToObserver) {
        const double d = focusDistanceOf(config, view, eye, transformDirection(head, {0, 0, -1}));
        return d > 0 ? observer.focusDistance / d : 1;
    }
    const double d = focusDistanceOf(config, view, {}, {0, 0, -1});
    return d > 0 && d + eye.z > 0 && observer.focusDistance + eye.z > 0 ? (observer.focusDistance + eye.z) / (d + eye.z)
                                                                        : 1;
}

} // namespace

Eyes eyesOf(const ResolvedConfig& config, const FrameInput& input, Index view, Eye eye) {
    Eyes e;
    Vector3 left{-config.eyeBase / 2, 0, 0}, cyclop, right{config.eyeBase / 2, 0, 0};
    const Index o = view == kNone ? kNone : config.views[at(view)].observer;
    if (o != kNone) {
        const config::ResolvedObserver& observer = config.observers[at(o)];
        left = observer.eyeLeft;
        cyclop = observer.eyeCyclop;
        right = observer.eyeRight;
        if (at(o) < input.observers.size()) e.head = input.observers[at(o)].head;
    }
    e.modelUnit = unitsOf(input, view).modelUnit;
    const Vector3& own = eye == Eye::Left ? left : eye == Eye::Right ? right : cyclop;
    e.cyclop = transformPoint(e.head, cyclop) * e.modelUnit;
    e.eye = transformPoint(e.head, own) * e.modelUnit;
    e.cyclopWithoutHead = cyclop * e.modelUnit;
    e.eyeWithoutHead = own * e.modelUnit;
    for (size_t row = 0; row < 3; ++row) e.head.m[row][3] *= e.modelUnit;
    return e;
}

Viewport coverage(const ResolvedConfig& config, const config::ResolvedChannel& channel) {
    if (!channel.isDestination()) return {};
    const Viewport& view = config.views[at(channel.view)].viewport;
    return relativeTo(intersect(config.segments[at(channel.segment)].viewport, view), view);
}

Screen destinationScreen(const ResolvedConfig& config, const FrameInput& input, const Inherited& inherited) {
    const config::ResolvedChannel& channel = config.channels[at(inherited.destination)];
    if (!channel.isDestination()) return inherited.screen.value_or(config::screenOf(config::Wall{}));
    const config::ResolvedView& view = config.views[at(channel.view)];
    const config::ResolvedSegment& segment = config.segments[at(channel.segment)];
    Screen screen;
    if (view.surface)
        screen = config::screenOf(*view.surface).part(coverage(config, channel));
    else
        screen = config::screenOf(segment.surface)
                     .part(segment.surfacePart)
                     .part(relativeTo(intersect(segment.viewport, view.viewport), segment.viewport));
    const double ratio = focusRatio(config, input, channel.view);
    if (ratio != 1 && view.observer != kNone) {
        const Matrix4 head =
            at(view.observer) < input.observers.size() ? input.observers[at(view.observer)].head : Matrix4{};
        const Vector3 eye = transformPoint(head, config.observers[at(view.observer)].eyeCyclop);
        screen.center = eye + (screen.center - eye) * ratio;
        screen.width *= ratio;
        screen.height *= ratio;
    }
    return screen;
}

Frustum partOf(const Frustum& f, const Viewport& part) {
    Frustum cut = f;
    cut.left = f.left + f.width() * part.x;
    cut.right = cut.left + f.width() * part.w;
    cut.bottom = f.bottom + f.height() * part.y;
    cut.top = cut.bottom + f.height() * part.h;
    return cut;
}

void setFrusta(const Screen& given, const Eyes& eyes, const Inherited& i, const Viewport& shown,
               const FrameInput& input, RenderContext& context) {
    Screen screen = given;
    // Overdraw enlarges the screen by the additional pixels around the view.
    const Overdraw& o = i.overdraw;
    const double w = std::max(1, i.whole.w - o.left - o.right), h = std::max(1, i.whole.h - o.bottom - o.top);
    screen = screen.part({-o.left / w, -o.bottom / h, i.whole.w / w, i.whole.h / h});
    screen.center = screen.center * eyes.modelUnit;
    screen.width *= eyes.modelUnit;
    screen.height *= eyes.modelUnit;

    const Matrix4 fromRoom = screen.fromRoom();
    const bool isHmd = screen.type == config::WallType::Hmd; // the screen of an HMD moves with the head
    Vector3 eye = transformPoint(fromRoom, isHmd ? eyes.eyeWithoutHead : eyes.eye);
    const Vector3 cyclop = transformPoint(fromRoom, isHmd ? eyes.cyclopWithoutHead : eyes.cyclop);
    if (std::abs(eye.z) < kClosest) eye.z = eye.z < 0 ? -kClosest : kClosest;

    const OffAxis edges = edgesFrom(screen, eye, input.nearPlane / std::abs(eye.z));
    context.behindScreen = edges.mirrored;
    context.destinationPerspective = {edges.left, edges.right,     edges.bottom,
                                      edges.top,  input.nearPlane, input.farPlane};
    context.perspective = partOf(context.destinationPerspective, shown);
    const OffAxis flat = edgesFrom(screen, cyclop, 1);
    context.orthographic =
        partOf({flat.left, flat.right, flat.bottom, flat.top, input.nearPlane, input.farPlane}, shown);

    const Matrix4 behindHead = isHmd ? rigidInverse(eyes.head) : Matrix4{};
    context.perspectiveHead = Matrix4::translation(eye * -1) * fromRoom * behindHead;
    Matrix4 shear; // parallel projections have no vanishing point; the shear creates the parallax
    shear.m[0][2] = (cyclop.x - eye.x) / eye.z;
    shear.m[1][2] = (cyclop.y - eye.y) / eye.z;
    context.orthographicHead = shear * Matrix4::translation(cyclop * -1) * fromRoom * behindHead;
}

} // namespace mural::compound
