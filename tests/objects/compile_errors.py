#!/usr/bin/env python3
"""Checks that types which cannot be fields are compile errors with a text that names the remedy.

  compile_errors.py COMPILER INCLUDE_FOLDER...
"""

import re
import subprocess
import sys
import tempfile

HEADER = """
#include <memory>
#include <mural/archive.hpp>
struct Inner { int a = 0; };
"""
# Each case is one line of a file of its own name, which the compiler's messages contain.
CASE = """#line 1 "case%d"
namespace case%d { struct Scene { %s template <class V> void fields(V& v) %s { v(field); } }; \
inline void use() { \
    mural::archive::EncodedSlots slots; \
    mural::archive::encodeSlots(Scene{}, slots); \
    Scene scene; \
    (void)mural::archive::decodeSlots(scene, 1, nullptr, [&](uint32_t slot) { return slots.bytesOf(slot); }); \
    (void)mural::archive::layoutOf<Scene>(); } }
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


def compiled(numbers):
    """Returns the status and the messages of a compilation of these cases."""
    with tempfile.NamedTemporaryFile("w", suffix=".cpp") as source:
        source.write(HEADER + "".join(CASE % (number, number, *CASES[number][:2]) for number in numbers))
        source.flush()
        command = [sys.argv[1], "-std=c++20", "-fsyntax-only", source.name] + ["-I" + folder for folder in sys.argv[2:]]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
    return result.returncode, result.stderr


def says(messages, number, text):
    """Tells whether an error with the text follows the mention of a case, before the next place in the program is named."""
    at = None
    for line in messages.splitlines():
        at = None if "In instantiation of" in line or "In function" in line else at
        mentioned = re.search(r"\bcase(\d+):\d+", line)
        at = int(mentioned.group(1)) if mentioned else at
        if at == number and "error: " in line and text in line:
            return True
    return False


def main():
    failed = 0
    _, together = compiled([number for number, case in enumerate(CASES) if case[2] is not None])
    for number, (field, _, text) in enumerate(CASES):
        # Most of the time of a compilation is the header's. A case whose error is not in the common output is compiled alone.
        if text is not None and says(together, number, text):
            continue
        status, messages = compiled([number])
        good = status == 0 if text is None else status != 0 and text in messages
        failed += not good
        if not good:
            print("%s: expected %s, but the compiler says:\n%s" % (field, text or "success", messages[:2000]))
    print("%d cases, %d failed" % (len(CASES), failed))
    return 1 if failed else 0


sys.exit(main())
