// Draws batched bitmaps before the node changes state. Mesa batches glBitmap, and draws the batch with the state at the
// next dependent command. That command must be the program's, not one that the node adds.
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

// Calls of display lists count only if some list contains a bitmap. settleBitmaps() has a side effect: Mesa commits
// pending materials, which a later colour would otherwise still change.
void Replay::onBitmaps(uint16_t opcode) {
    if (!hasTrait(opcode, Trait::Bitmap, Trait::CallList)) return;
    const bool bitmap = hasTrait(opcode, Trait::Bitmap);
    if (bitmap && c_->compiling && c_->shared) c_->shared->listsContainBitmaps = true;
    if (bitmap || (c_->shared && c_->shared->listsContainBitmaps)) c_->gathersBitmaps = true;
}

// Commands that neither draw nor change drawing state: the driver continues its batch, as it does natively.
bool Replay::leavesBitmaps(uint16_t opcode) {
    switch (opcode) {
    case wire::kOpBlobBegin:
    case wire::kOpBlobData:
    case wire::kOpClientArrays:
    case wire::kOpRequestBuffer:
    case wire::kOpRequestQuery:
    case wire::kOpRequestProgram:
    case wire::kOpQueryKnown:
    case wire::kOpProgramLayout:
    case wire::kOpBufferBytes:
    case wire::kOpErrorReported: return true;
    default: return false;
    }
}

// Draws the batch with the program's own state, as its next command would.
void Replay::settleBitmaps() {
    if (!bound_ || c_ != bound_ || !c_->gathersBitmaps || c_->compiling || !gl.glBegin || !gl.glEnd || !gl.glFlush)
        return;
    if (!gl.glGetString(GL_VENDOR)) return; // between glBegin and glEnd, where queries fail
    c_->gathersBitmaps = false;
    gl.glBegin(GL_POINTS); // makes Mesa validate programs and samplers; unvalidated ones cause a null pointer access
    gl.glEnd();
    gl.glFlush();
}

} // namespace mural
