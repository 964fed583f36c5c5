#!/usr/bin/env python3
"""A program outside of the tree builds against the installed library, by CMake and by pkg-config, and draws.

  installed_library.py BUILD
"""

import glob
import os
import shutil
import subprocess
import sys
import tempfile

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(outside CXX)
find_package(mural 0.1 REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS OpenGL)
add_executable(hello hello.cpp)
target_link_libraries(hello mural::mural OpenGL::OpenGL)
"""


def run(words, environment=None, folder=None):
    done = subprocess.run(words, env=dict(os.environ, **(environment or {})), cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=300, check=False)
    if done.returncode != 0:
        raise SystemExit("%s: status %d\n%s" % (" ".join(words), done.returncode, done.stdout[-2000:]))
    return done.stdout


def draws(build, binary, prefix, folder):
    """Returns the number of pictures that the program shows on two nodes."""
    out = os.path.join(folder, "out-" + os.path.basename(binary))
    run([os.path.join(build, "bin", "mural"), "run", "--tiles", "2x1", "--display", "none", "--size", "160x120", "--frames", "3", "--out", out, "--", binary],
        {"LD_LIBRARY_PATH": glob.glob(os.path.join(prefix, "lib*"))[0]})
    return len(os.listdir(out))


def main():
    build = os.path.abspath(sys.argv[1])
    for tool in ("cmake", "pkg-config", "c++"):
        if not shutil.which(tool):
            raise SystemExit("%s is missing; tools/install-deps build" % tool)
    with tempfile.TemporaryDirectory(prefix="mural-installed.") as folder:
        prefix, source = os.path.join(folder, "prefix"), os.path.join(folder, "source")
        for component in ("libmural", "libmural-dev"):
            run(["cmake", "--install", build, "--prefix", prefix, "--component", component])
        os.makedirs(source)
        shutil.copy(os.path.join(TOP, "examples", "hello", "hello.cpp"), source)
        with open(os.path.join(source, "CMakeLists.txt"), "w", encoding="ascii") as file:
            file.write(PROJECT)
        by_cmake, by_pkg_config = os.path.join(folder, "build", "hello"), os.path.join(folder, "hello-pkg-config")
        run(["cmake", "-S", source, "-B", os.path.dirname(by_cmake), "-DCMAKE_PREFIX_PATH=" + prefix])
        run(["cmake", "--build", os.path.dirname(by_cmake)])
        pc = glob.glob(os.path.join(prefix, "lib*", "**", "mural.pc"), recursive=True)
        flags = run(["pkg-config", "--define-variable=prefix=" + prefix, "--define-prefix", "--cflags", "--libs", "mural"],
                    {"PKG_CONFIG_PATH": os.path.dirname(pc[0])}).split()
        run(["c++", os.path.join(source, "hello.cpp"), "-o", by_pkg_config] + flags + ["-lOpenGL"])
        counts = [draws(build, binary, prefix, folder) for binary in (by_cmake, by_pkg_config)]
    print("by CMake %d pictures, by pkg-config %d" % tuple(counts))
    return 0 if counts == [3, 3] else 1


sys.exit(main())
