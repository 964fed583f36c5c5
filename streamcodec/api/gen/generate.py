#!/usr/bin/env python3
"""Generates the command table, the encoder, the wrappers and the replay from the OpenGL registry.

  generate.py --registry gl.xml --glx-registry glx.xml --egl-header EGL/egl.h --out DIR
                                                     writes DIR/*.hpp, DIR/*.cpp
  generate.py --registry gl.xml --update-lock        appends new commands to opcodes.lock

The output is not in git. Opcodes are stable: streamcodec/api/opcodes.lock is append-only.
"""
import argparse
import os
import sys
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import emit_common        # noqa: E402
import emit_epoxy         # noqa: E402
import emit_preload         # noqa: E402
import emit_interposer    # noqa: E402
import emit_parameters    # noqa: E402
import emit_replay        # noqa: E402
import emit_traits        # noqa: E402
import registry           # noqa: E402

REGISTRY_DIR = os.path.dirname(HERE)
FIRST_OPCODE = 64


def read_lock(path):
    names = []
    if os.path.exists(path):
        names = [line.strip() for line in open(path, encoding='utf-8') if line.strip() and line[0] != '#']
    return names


def update_lock(path, commands):
    known = read_lock(path)
    have = set(known)
    new = sorted(c.name for c in commands.values() if not c.alias and c.name not in have)
    with open(path, 'w', encoding='utf-8') as f:
        f.write('# Opcodes of the stream: line n (from 0, comments not counted) is opcode %d + n.\n'
                '# Append only: generate.py --update-lock.\n' % FIRST_OPCODE)
        f.writelines(n + '\n' for n in known + new)
    print('%s: %d known, %d new' % (path, len(known), len(new)))


def write_if_changed(path, text):
    if os.path.exists(path) and open(path, encoding='utf-8').read() == text:
        return
    with open(path, 'w', encoding='utf-8') as f:
        f.write(text)


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument('--registry', required=True)
    a.add_argument('--glx-registry')
    a.add_argument('--egl-header')
    a.add_argument('--semantics', default=os.path.join(REGISTRY_DIR, 'semantics.txt'))
    a.add_argument('--lock', default=os.path.join(REGISTRY_DIR, 'opcodes.lock'))
    a.add_argument('--out')
    a.add_argument('--update-lock', action='store_true')
    o = a.parse_args()
    commands, extensions = registry.load(o.registry, o.semantics)
    if o.update_lock:
        update_lock(o.lock, commands)
        return
    names = read_lock(o.lock)
    opcode = {n: FIRST_OPCODE + i for i, n in enumerate(names)}
    missing = [c.name for c in commands.values() if not c.alias and c.name not in opcode]
    if missing:
        # The registry is newer than the lock. Its new commands are unsupported until the lock is updated.
        for n in missing:
            commands[n].command_class = 'unsupported'
            commands[n].reason = 'newer than opcodes.lock'
    digest = zlib.crc32(open(o.lock, 'rb').read()) << 32 | zlib.crc32(open(o.semantics, 'rb').read())
    model = emit_common.Model(commands, extensions, opcode, digest)
    os.makedirs(o.out, exist_ok=True)
    files = {}
    files.update(emit_common.emit(model))
    files.update(emit_interposer.emit(model))
    files.update(emit_replay.emit(model))
    files.update(emit_epoxy.emit(model))
    files.update(emit_parameters.emit(model, o.registry))
    files.update(emit_traits.emit(model))
    if o.glx_registry and o.egl_header:
        files.update(emit_preload.emit(model, o.glx_registry, o.egl_header))
    for name, text in files.items():
        write_if_changed(os.path.join(o.out, name), text)


main()
