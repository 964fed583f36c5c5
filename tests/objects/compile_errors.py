#!/usr/bin/env python3
"""Checks that types which cannot be fields are compile errors with a text that names the remedy.

  compile_errors.py COMPILER INCLUDE_FOLDER...
"""

import subprocess
import sys
import tempfile

PROGRAM = """
#include <memory>
#include <mural/archive.hpp>
struct Inner { int a = 0; };
struct Scene { %s template <class V> void fields(V& v) %s { v(field); } };
int main() {
    mural::archive::EncodedSlots slots;
    mural::archive::encodeSlots(Scene{}, slots);
    Scene scene;
    (void)mural::archive::decodeSlots(scene, 1, nullptr, [&](uint32_t slot) { return slots.bytesOf(slot); });
    (void)mural::archive::layoutOf<Scene>();
}
"""
POINTER = "a pointer cannot be a field: use std::optional<T>, std::vector<T>, mural::Ref<T> or mural::Blob"
CASES = (
    ("double field = 0;", "", None),
    ("int* field = nullptr;", "", POINTER),
    ("std::shared_ptr<int> field;", "", POINTER),
    ("std::vector<std::unique_ptr<int>> field;", "", POINTER),
    ("long double field = 0;", "", "cannot be a field: use double"),
    ("Inner field;", "", "give it a member"),
    ("const int field = 0;", "", "may be const"),
    ("int field = 0;", "const", "may be const"),
    ("int other = 0; int& field; Scene() : field(other) {} Scene(int& f) : field(f) {} "
     "Scene(Scene&&) = delete;", "", "in place of a reference use a value or"),
)


def main():
    compiler, folders = sys.argv[1], sys.argv[2:]
    failed = 0
    for field, qualifier, text in CASES:
        with tempfile.NamedTemporaryFile("w", suffix=".cpp") as source:
            source.write(PROGRAM % (field, qualifier))
            source.flush()
            command = [compiler, "-std=c++20", "-fsyntax-only", source.name] + ["-I" + folder for folder in folders]
            result = subprocess.run(command, capture_output=True, text=True, check=False)
        good = result.returncode == 0 if text is None else result.returncode != 0 and text in result.stderr
        failed += not good
        if not good:
            print("%s: expected %s, but the compiler says:\n%s" % (field, text or "success", result.stderr[:2000]))
    print("%d cases, %d failed" % (len(CASES), failed))
    return 1 if failed else 0


sys.exit(main())
