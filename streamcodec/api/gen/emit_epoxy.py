"""Emits the list of commands that a render node takes from libepoxy (docs/decisions/0002-entry-points-of-the-nodes.md).

libepoxy resolves a command once per process, at its first call. If the context of that call has the command only under
another name, libepoxy uses that name for all later contexts, which may lack it. A command therefore comes from libepoxy
under two conditions. No kind of context can offer it another name. And libepoxy may query the context at the first
call, which is not possible between glBegin and glEnd.
"""
import re

from emit_common import HEAD

BASE = {'gl': 2.0, 'gles1': 1.0, 'gles2': 2.0} # minimum version of every context of a node
# libepoxy treats these as aliases of other commands, although they differ.
HALF_ALIASES = ('glBindVertexArray', 'glBindFramebuffer', 'glBindRenderbuffer')
# glBegin, glEnd and the commands that are valid between them.
IN_PRIMITIVE = re.compile(
    r'gl(Begin|End|EdgeFlagv?|ArrayElement|CallLists?|PrimitiveRestart(Index)?|EvalPoint[12]'
    r'|(Vertex|Normal|Color|SecondaryColor|Index|FogCoord|(Multi)?TexCoord|EvalCoord|Material|(Vertex)?Weight'
    r'|VertexAttribs?[IL]?|(Vertex|Normal)Stream)(P?\dN?)?(u?[bsi]|[fdhx]|u?i64)v?)(ARB|EXT|NV|OES|ATI)?$')
# Up to these versions libepoxy resolves commands by dlsym in a library. It ends the process if the library lacks one.
BY_LIBRARY = {'gl': (1.2, 'kGl'), 'gles1': (1.1, 'kEs1'), 'gles2': (2.0, 'kEs2')}


def offers_another_name(c, others, api):
    if c.core.get(api, BASE[api] + 1) <= BASE[api]:
        return False
    return any(api in o.core or api in o.extension_apis for o in others)


def libraries(c):
    return [flag for api, (last, flag) in BY_LIBRARY.items() if c.core.get(api, last + 1) <= last]


def emit(m):
    groups = {}
    for c in m.all.values():
        groups.setdefault(m.of(c).name, []).append(c)
    text = HEAD + '// Sorted by name; the libraries in which libepoxy must find the command.\n'
    for c in sorted(m.all.values(), key=lambda x: x.name):
        others = [o for o in groups[m.of(c).name] if o is not c]
        if IN_PRIMITIVE.match(c.name) or c.name.removesuffix('EXT').removesuffix('APPLE') in HALF_ALIASES:
            continue
        if not any(offers_another_name(c, others, api) for api in BASE):
            text += '{"%s", %s},\n' % (c.name, ' | '.join(libraries(c)) or '0')
    return {'epoxy_commands.inc': text}
