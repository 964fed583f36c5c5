// Two ways into one context (mixed.hpp), with a window through GLX.
#include "tests/programs/routes/glx_functions.hpp"
#include "tests/programs/routes/mixed.hpp"

extern "C" programs::GlFunction glXGetProcAddressARB(const GLubyte* name);

namespace {

programs::GlFunction findGlx(const char* name) { return glXGetProcAddressARB(reinterpret_cast<const GLubyte*>(name)); }

programs::GlFunction findGl(const char* name) {
    return programs::isImmediate(name) ? programs::findElsewhere(name) : findGlx(name);
}

} // namespace

int main(int argc, char** argv) {
    return programs::runSceneByGlx(programs::parseOptions(argc, argv), findGlx, findGl, programs::printWhetherComplete);
}
