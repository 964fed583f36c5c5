#!/usr/bin/env python3
"""Writes a C++ source with the files of the page and the schema of the control interface.

  embed_assets.py --out FILE.cpp --schema FILE.json [--files FOLDER]
"""

import argparse
import gzip
import os
import sys

TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".ico": "image/x-icon",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
    ".webmanifest": "application/manifest+json",
    ".woff2": "font/woff2",
}
COLUMNS = 32


def array_of(name, data):
    lines = [", ".join(str(byte) for byte in data[at:at + COLUMNS]) for at in range(0, len(data), COLUMNS)]
    return "constexpr unsigned char %s[] = {\n%s};\n" % (name, ",\n".join(lines) or "0")


def text_of(name, size):
    return "{reinterpret_cast<const char*>(%s), %d}" % (name, size)


def files_of(folder):
    found = []
    for path, folders, files in os.walk(folder):
        folders.sort()
        found += [os.path.join(path, name) for name in sorted(files)]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", required=True)
    parser.add_argument("--schema", required=True)
    parser.add_argument("--files")
    arguments = parser.parse_args()
    arrays, entries = [], []
    for number, path in enumerate(files_of(arguments.files) if arguments.files else []):
        suffix = os.path.splitext(path)[1]
        if suffix == ".map":
            continue
        if suffix not in TYPES:
            print("embed_assets: %s: files of the page have the suffixes %s" % (path, ", ".join(sorted(TYPES))), file=sys.stderr)
            return 1
        with open(path, "rb") as file:
            data = file.read()
        packed = gzip.compress(data, 9, mtime=0)
        is_packed = len(packed) < len(data)
        stored = packed if is_packed else data
        arrays.append(array_of("kFile%d" % number, stored))
        name = "/" + os.path.relpath(path, arguments.files).replace(os.sep, "/")
        entries.append('    {"%s", "%s", %s, %s},\n' % (name, TYPES[suffix], "true" if is_packed else "false", text_of("kFile%d" % number, len(stored))))
    with open(arguments.schema, "rb") as file:
        schema = file.read()
    arrays.append(array_of("kSchema", schema))
    with open(arguments.out, "w", encoding="ascii") as out:
        out.write("// Written by embed_assets.py.\n#include <array>\n\n#include \"tools/mural/page/http/page_assets.hpp\"\n\nnamespace mural::page {\n\nnamespace {\n\n")
        out.write("\n".join(arrays))
        out.write("\n} // namespace\n\nstd::span<const PageAsset> pageAssets() {\n")
        out.write("    static const std::array<PageAsset, %d> kAll = {{\n%s    }};\n    return kAll;\n}\n\n" % (len(entries), "".join(entries)))
        out.write("std::string_view controlSchema() { return %s; }\n\n} // namespace mural::page\n" % text_of("kSchema", len(schema)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
