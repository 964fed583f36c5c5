// GLFW with its native X11 side. GLFW's own glfw3native.h asks for the headers of Xrandr, which
// nothing here needs otherwise: its two functions are declared here instead. For .cpp files only:
// Xlib's macros (None, Success, Bool) break other headers.
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <X11/Xlib.h>

extern "C" {
GLFWAPI Display* glfwGetX11Display(void);
GLFWAPI Window glfwGetX11Window(GLFWwindow* window);
}
