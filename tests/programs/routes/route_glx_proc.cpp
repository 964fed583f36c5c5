// Links only glXGetProcAddressARB of OpenGL, and finds everything through it.
#include "tests/programs/routes/glx_functions.hpp"

extern "C" programs::GlFunction glXGetProcAddressARB(const GLubyte* name);

namespace {

programs::GlFunction find(const char* name) { return glXGetProcAddressARB(reinterpret_cast<const GLubyte*>(name)); }

} // namespace

int main(int argc, char** argv) { return programs::runSceneByGlx(programs::parseOptions(argc, argv), find, find); }
