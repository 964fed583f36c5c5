// The state behind a RenderTask: one task of one frame.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <mural/render.hpp>

#include "native/runtime/client_objects.hpp"
#include "native/runtime/frame_part.hpp"
#include "native/runtime/gl_target.hpp"
#include "native/runtime/view.hpp"

namespace mural::native {

class TaskState {
public:
    TaskState(const FramePart& framePart, const ViewInput& viewInput, const Frame& frameInfo, bool isSameAsBefore,
              const Composition& how, GlTarget& glTarget, ClientObjects& clientObjects,
              std::function<void(const std::string&)> reporter)
        : part(framePart),
          view(viewInput),
          frame(frameInfo),
          sameAsBefore(isSameAsBefore),
          composition(how),
          target(glTarget),
          objects(clientObjects),
          report(std::move(reporter)) {}

    // Selects the framebuffer for this part.
    void apply();

    const FramePart& part;
    ViewInput view;
    const Frame frame;
    const bool sameAsBefore;
    const Composition composition;
    GlTarget& target;
    ClientObjects& objects;
    const std::function<void(const std::string& text)> report;
    std::vector<std::shared_ptr<const void>> snapshots; // that the tasks of this frame use
    std::function<void()> beforeApply;                  // called once by apply(), before it; may be empty
};

} // namespace mural::native
