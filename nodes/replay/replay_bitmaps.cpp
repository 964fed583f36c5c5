// Mesa gathers what glBitmap draws, and draws it before the next command that needs it: with the state of that moment. What
// the node does by itself between the two must not be that moment.
#include "gl_opcodes.hpp"
#include "nodes/replay/replay.hpp"

namespace mural {

// Lists gather some only when any of them holds one: what settleBitmaps() does is not without a trace (Mesa takes
// materials that are on their way, where a colour would have followed them).
void Replay::noteBitmaps(uint16_t opcode) {
    if (opcode == op::glBitmap && c_->compiling && c_->shared) c_->shared->listsHoldBitmaps = true;
    const bool listed = (opcode == op::glCallList || opcode == op::glCallLists) && c_->shared && c_->shared->listsHoldBitmaps;
    if (opcode == op::glBitmap || listed) c_->gathersBitmaps = true;
}

// What neither draws nor changes what draws: the driver goes on gathering, as it does without these.
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
    case wire::kOpErrorTold: return true;
    default: return false;
    }
}

// With the program's own state, as the command would that comes next.
void Replay::settleBitmaps() {
    if (!bound_ || c_ != bound_ || !c_->gathersBitmaps || c_->compiling || !gl.glBegin || !gl.glEnd || !gl.glFlush) return;
    if (!gl.glGetString(GL_VENDOR)) return; // between glBegin and glEnd, where nothing is answered
    c_->gathersBitmaps = false;
    gl.glBegin(GL_POINTS); // Mesa looks at programs and samplers here; where it had not yet, it read through a null pointer
    gl.glEnd();
    gl.glFlush();
}

} // namespace mural
