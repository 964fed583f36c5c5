// GLFW with its native X11 functions. glfw3native.h includes the headers of Xrandr, which nothing else here needs, so
// this header declares its two functions. For .cpp files only: Xlib's macros (None, Success, Bool) break other headers.
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <X11/Xlib.h>

extern "C" {
GLFWAPI Display* glfwGetX11Display(void);
GLFWAPI Window glfwGetX11Window(GLFWwindow* window);
}
