#include "nodes/head/session/canvas_composition.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "nodes/frame_transfer/transfer_scale.hpp"

namespace mural {
namespace {

int side(int pixels, double scale) { return std::max(1, static_cast<int>(std::lround(pixels * scale))); }

void makeBlack(int width, int height, OwnedPicture& into) {
    into.resize(width, height, PictureFormat::Bgra8);
    std::memset(into.data(), 0, into.view().sizeBytes());
}

// Composes a canvas that is off. The first picture has the size of the program's picture.
PictureAssembler::Compose composeBlack(const Zoom& shown) {
    return [shown](const std::vector<Picture>& passes, OwnedPicture& into) {
        makeBlack(side(passes.front().width, shown.x), side(passes.front().height, shown.y), into);
    };
}

// Returns the composition of one eye. Anaglyphs contain both.
WallComposition oneEyeOf(WallComposition wall) {
    if (wall.stereo == StereoMode::Anaglyph) return wall;
    std::erase_if(wall.parts, [](const WallPart& part) { return part.eye == Eye::Right; });
    wall.stereo = StereoMode::Off;
    return wall;
}

// Composes a canvas that shows parts of canvases.
class CopyComposer {
public:
    CopyComposer(const SessionPlan& plan, const WallComposition& own, const Zoom& shown) : own_(own), shown_(shown) {
        for (const PictureCopy& copy : own.copies) {
            const auto index = static_cast<size_t>(copy.canvas);
            if (sources_.size() <= index) sources_.resize(index + 1);
            sources_[index] = copy.canvas == 0
                                  ? Source{oneEyeOf(plan.wall), {}}
                                  : Source{oneEyeOf(plan.canvases[index - 1].wall), plan.canvases[index - 1].shown};
        }
    }

    void operator()(const std::vector<Picture>& passes, OwnedPicture& into) const {
        into.resize(0, 0);
        if (!own_.parts.empty()) composeWall(own_, passes, into);
        for (size_t canvas = 0; canvas < sources_.size(); ++canvas) {
            const Source& source = sources_[canvas];
            OwnedPicture picture;
            if (!source.wall.parts.empty()) composeWall(source.wall, passes, picture);
            if (picture.view().empty()) continue;
            if (into.view().empty())
                makeBlack(side(picture.width(), shown_.x / source.shown.x),
                          side(picture.height(), shown_.y / source.shown.y), into);
            for (const PictureCopy& copy : own_.copies)
                if (copy.canvas == static_cast<int>(canvas)) paste(picture, copy, into);
        }
    }

private:
    struct Source {
        WallComposition wall; // no parts: no copy shows it
        Zoom shown;
    };

    static void paste(const OwnedPicture& source, const PictureCopy& copy, OwnedPicture& into) {
        const PixelViewport all{0, 0, source.width(), source.height()}, target{0, 0, into.width(), into.height()};
        const PixelViewport from = intersect(apply(all, copy.from), all),
                            to = intersect(apply(target, copy.to), target);
        if (from.empty() || to.empty()) return;
        OwnedPicture part = cutOut(source.view(), from);
        OwnedPicture scaled;
        scaled.resize(to.w, to.h, PictureFormat::Bgra8);
        resizePicture(part.data(), from.w, from.h, scaled.data(), to.w, to.h);
        copyInto(into, to.x, to.y, scaled.view());
    }

    WallComposition own_;
    Zoom shown_;
    std::vector<Source> sources_; // by canvas
};

PictureAssembler::Compose composeBy(const SessionPlan& plan, const WallComposition& wall, const Zoom& shown) {
    if (!wall.copies.empty()) return CopyComposer(plan, wall, shown);
    return [wall](const std::vector<Picture>& passes, OwnedPicture& into) { composeWall(wall, passes, into); };
}

} // namespace

PictureAssembler::Compose composeFirst(const SessionPlan& plan) {
    if (picturesOf(plan.wall) == 1 && plan.wall.copies.empty()) return {};
    return composeBy(plan, plan.wall, {});
}

std::vector<PictureAssembler::Compose> composeOthers(const SessionPlan& plan, const SessionPlan& outputs) {
    std::vector<PictureAssembler::Compose> others;
    for (const CanvasPlan& output : outputs.canvases) {
        const auto canvas = std::ranges::find(plan.canvases, output.name, &CanvasPlan::name);
        others.push_back(canvas == plan.canvases.end() ? composeBlack(output.shown)
                                                       : composeBy(plan, canvas->wall, canvas->shown));
    }
    return others;
}

} // namespace mural
