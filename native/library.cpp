// The shared library consists of static ones (CMakeLists.txt). CMake requires a source of its own.
