#include "nodes/output/windows/monitors.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "nodes/output/windows/glfw_x11.hpp"

namespace mural {

Result<ScreenFacts> readScreen(const std::string& display) {
    setenv("DISPLAY", display.c_str(), 1); // GLFW reads only this
    if (glfwInit() != GLFW_TRUE)
        return Error{"the X display " + display + " cannot be opened; check that it runs and admits this user (xhost)"};
    ScreenFacts facts;
    Display* x = glfwGetX11Display();
    facts.width = DisplayWidth(x, DefaultScreen(x));
    facts.height = DisplayHeight(x, DefaultScreen(x));
    int count = 0;
    GLFWmonitor** all = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        MonitorFacts m;
        if (const char* name = glfwGetMonitorName(all[i])) m.name = name;
        glfwGetMonitorPos(all[i], &m.x, &m.y);
        if (const GLFWvidmode* mode = glfwGetVideoMode(all[i]))
            std::tie(m.width, m.height) = std::tie(mode->width, mode->height);
        glfwGetMonitorPhysicalSize(all[i], &m.widthMm, &m.heightMm);
        facts.monitors.push_back(std::move(m));
    }
    std::stable_sort(facts.monitors.begin(), facts.monitors.end(), [](const MonitorFacts& a, const MonitorFacts& b) {
        return std::tie(a.y, a.x) < std::tie(b.y, b.x);
    });
    glfwTerminate();
    return facts;
}

} // namespace mural
