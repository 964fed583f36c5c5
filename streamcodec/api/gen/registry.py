"""Model of the OpenGL registry: commands, their parameters, and the additions of semantics.txt.

Source: gl.xml of Debian's khronos-api, streamcodec/api/semantics.txt.
"""
import fnmatch
import re
import xml.etree.ElementTree as ET

TYPE_BYTES = {
    'GLboolean': 1, 'GLubyte': 1, 'GLbyte': 1, 'GLchar': 1, 'GLcharARB': 1,
    'GLshort': 2, 'GLushort': 2, 'GLhalf': 2, 'GLhalfNV': 2, 'GLhalfARB': 2,
    'GLint': 4, 'GLuint': 4, 'GLenum': 4, 'GLsizei': 4, 'GLfloat': 4, 'GLbitfield': 4,
    'GLclampf': 4, 'GLfixed': 4, 'GLclampx': 4, 'GLhandleARB': 4,
    'GLdouble': 8, 'GLclampd': 8, 'GLint64': 8, 'GLuint64': 8, 'GLint64EXT': 8, 'GLuint64EXT': 8,
    'GLintptr': 8, 'GLsizeiptr': 8, 'GLintptrARB': 8, 'GLsizeiptrARB': 8, 'GLsync': 8, 'GLeglImageOES': 8,
}
# Types that are meaningful only within one process, or that no supported command uses.
HANDLE_TYPES = ('GLsync', 'GLeglImageOES') # pointers of the program that serve as names
FOREIGN_TYPES = ('GLeglClientBufferEXT', 'GLVULKANPROCNV', 'GLvdpauSurfaceNV',
                 'GLDEBUGPROC', 'GLDEBUGPROCARB', 'GLDEBUGPROCAMD', 'GLDEBUGPROCKHR', '_cl_context', '_cl_event')

KINDS = {'texture': 'Texture', 'buffer': 'Buffer', 'framebuffer': 'Framebuffer', 'renderbuffer': 'Renderbuffer',
         'vertex array': 'VertexArray', 'query': 'Query', 'sampler': 'Sampler', 'program': 'Program',
         'shader': 'Program', 'program pipeline': 'Pipeline', 'transform feedback': 'TransformFeedback',
         'arb program': 'ArbProgram', 'display list': None, 'sync': None}
# Commands of ARB_vertex_program and similar extensions, whose programs have a separate name space.
ARB_PROGRAM = re.compile(r'gl(Bind|Delete|Gen|Is)Programs?(ARB|NV)$|glExecuteProgramNV$')

QUERY = re.compile(r'gl(Get|Is|AreTextures|AreProgramsResident|CheckFramebuffer|CheckNamedFramebuffer|Query|Test|Finish(Async|Object)|Poll)')


class Param:
    def __init__(self, element):
        text = ''.join(element.itertext())
        self.name = element.find('name').text
        self.type = re.sub(r'\s+', ' ', text[:text.rindex(self.name)]).strip()
        self.length = element.get('len')
        self.object_class = element.get('class')
        self.group = element.get('group')
        self.pointers = self.type.count('*')
        self.const = 'const' in self.type.split('*')[0]
        self.base = re.sub(r'\bconst\b|\*|\bstruct\b', '', self.type).strip()
        self.how = None      # set by Command.classify
        self.expr = None

    @property
    def kind(self):
        return KINDS.get(self.object_class) if self.object_class else None


class Command:
    def __init__(self, element):
        proto = element.find('proto')
        self.name = proto.find('name').text
        text = ''.join(proto.itertext())
        self.returns = re.sub(r'\s+', ' ', text[:text.rindex(self.name)]).strip()
        self.return_class = proto.get('class')
        self.params = [Param(p) for p in element.findall('param')]
        if ARB_PROGRAM.match(self.name):
            for p in self.params:
                if p.object_class == 'program' or p.name in ('programs', 'id'):
                    p.object_class = 'arb program'
        alias = element.find('alias')
        self.alias = alias.get('name') if alias is not None else None
        self.options = {}
        self.traits = set()
        self.command_class = None
        self.reason = ''
        self.feature = None
        self.core = {} # by API: the first version with the command
        self.extensions = []
        self.extension_apis = set() # APIs in which an extension adds the command

    def option(self, key, default=None):
        return self.options.get(key, default)

    @property
    def sent(self):
        return self.command_class not in ('unsupported', 'query') and self.option('send') != 'no'

    def param(self, name):
        return next((p for p in self.params if p.name == name), None)

    def classify(self):
        """Determines the class and the transfer of each parameter. Otherwise sets class unsupported, with a reason."""
        self.command_class = self.options.get('class')
        wanted_unsupported = self.command_class == 'unsupported'
        outputs = [p for p in self.params if p.pointers and not p.const]
        makes = re.match(r'gl(Gen|Create)', self.name) and (
            any(p.kind and p.pointers == 1 for p in outputs) or self.returns in ('GLuint', 'GLhandleARB'))
        if self.command_class is None:
            if makes:
                self.command_class = 'object'
            elif QUERY.match(self.name) or outputs or self.returns != 'void':
                self.command_class = 'query'
            else:
                self.command_class = 'state'
        if wanted_unsupported:
            self.reason = self.options.get('why', '')
            return
        if not self.sent:
            return
        for p in self.params:
            problem = self._how(p)
            if problem:
                self.command_class = 'unsupported'
                self.reason = problem
                return
        if self.returns != 'void' and self.command_class != 'object' and self.option('app') != 'custom':
            self.command_class = 'unsupported'
            self.reason = 'its return value is not described'

    def _how(self, p):
        if p.base in FOREIGN_TYPES or (p.pointers == 0 and p.base not in TYPE_BYTES):
            return 'parameter %s of type %s is a handle of one process' % (p.name, p.base)
        if p.pointers == 0:
            p.how = 'handle' if p.base in HANDLE_TYPES else 'scalar'
            if p.object_class is None and self.option('kind.' + p.name):
                p.object_class = self.option('kind.' + p.name)
            return None
        if 'offset.' + p.name in self.options:
            p.how = 'offset'
            return None
        if 'data.' + p.name in self.options:
            p.how, p.expr = 'data', self.options['data.' + p.name]
            return None
        if 'strings.' + p.name in self.options:
            p.how, p.expr = 'strings', self.options['strings.' + p.name]
            return None
        if any(key.startswith('strings.') and value == p.name for key, value in self.options.items()):
            p.how = 'skip'
            return None
        if 'pixels.' + p.name in self.options:
            p.how, p.expr = 'pixels', self.options['pixels.' + p.name]
            return None
        if 'packed.' + p.name in self.options:
            p.how, p.expr = 'packed', self.options['packed.' + p.name]
            return None
        if 'size.' + p.name in self.options:
            p.how, p.expr = 'array', self.options['size.' + p.name]
            if p.kind and not p.length:  # names are translated one by one
                counted = re.match(r'n4\((\w+),', p.expr)
                if not counted:
                    return 'the number of names in %s is not described' % p.name
                p.length = counted.group(1)
            return None
        if not p.const:
            if self.command_class == 'object' and p.kind:
                p.how = 'made'
                return None
            return 'writes to %s' % p.name
        if p.pointers > 1:
            return 'array of pointers %s is not described' % p.name
        if p.base in ('GLchar', 'GLcharARB') and (p.length in (None, 'COMPSIZE(name)', 'COMPSIZE()')):
            p.how = 'text'
            return None
        if p.length is None or 'COMPSIZE' in p.length:
            return 'the size of %s is not described by the registry' % p.name
        size = TYPE_BYTES.get(p.base, 1 if p.base in ('void', 'GLvoid') else 0)
        if not size:
            return 'type %s of %s is unknown' % (p.base, p.name)
        product = re.fullmatch(r'(\w+)\*(\d+)', p.length)
        if p.length.isdigit():
            p.how, p.expr = 'fixed', int(p.length) * size
        elif product: # multiplied in 64 bits, because an overflow would make a large count look small
            p.how, p.expr = 'array', 'vn(%s,%d)' % (product.group(1), int(product.group(2)) * size)
        else:
            p.how, p.expr = 'array', 'vn(%s,%d)' % (p.length, size)
        return None


def read_semantics(path):
    rules = []
    with open(path, encoding='utf-8') as f:
        lines = list(f)
    for number, line in enumerate(lines, 1):
        line = line.split('#', 1)[0].strip() if not line.lstrip().startswith('#') else ''
        if not line:
            continue
        why = ''
        if ' why=' in line:
            line, why = line.split(' why=', 1)
        words = line.split()
        options = {}
        if words[1] != '-':
            options['class'] = words[1]
        for word in words[2:]:
            key, _, value = word.partition('=')
            options[key] = value or True
        if why:
            options['why'] = why.strip()
        rules.append((words[0], options, number))
    return rules


def load(gl_xml, semantics):
    root = ET.parse(gl_xml).getroot()
    commands = {}
    for element in root.find('commands'):
        c = Command(element)
        commands[c.name] = c
    for feature in root.findall('feature'):
        for require in feature.findall('require'):
            for c in require.findall('command'):
                command = commands[c.get('name')]
                command.feature = command.feature or feature.get('name')
                api, version = feature.get('api'), float(feature.get('number'))
                command.core[api] = min(version, command.core.get(api, version))
    rules = read_semantics(semantics)
    for name, options, _ in rules:
        if 'alias' in options:
            commands[name].alias = None if options['alias'] == 'none' else options['alias']
    root_aliases(commands)
    for pattern, options, number in rules:
        hit = False
        traits = set(options.pop('traits').split(',')) if 'traits' in options else set()
        for name in commands:
            if name == pattern or fnmatch.fnmatchcase(name, pattern):
                hit = True
                commands[name].traits |= traits
                if 'class' in options: # a new class keeps only options with a dot; 'unsupported' keeps none
                    kept = {} if options['class'] == 'unsupported' else {
                        k: v for k, v in commands[name].options.items() if '.' in k}
                    commands[name].options = kept
                if 'effect' in options:
                    for key in ('attrib', 'object'):
                        commands[name].options.pop(key, None)
                commands[name].options.update(options)
        if not hit:
            raise SystemExit('%s:%d: no command matches %s' % (semantics, number, pattern))
    extensions = {}
    for ext in root.find('extensions'):
        names = [c.get('name') for r in ext.findall('require') for c in r.findall('command')]
        extensions[ext.get('name')] = (ext.get('supported'), names)
        for n in names:
            commands[n].extensions.append(ext.get('name'))
            commands[n].extension_apis.update(ext.get('supported').split('|'))
    for c in commands.values():
        c.classify()
    check_traits(semantics, commands)
    return commands, extensions


OF_RECORDS = {'traits', 'effect', 'deferral', 'cell', 'list', 'vertices'} # options that describe commands of the stream


def check_traits(semantics, commands):
    """Fails for a line with traits or an effect that matches no command of the stream."""
    for pattern, options, number in read_semantics(semantics):
        if OF_RECORDS & options.keys() and not any(c.sent and not c.alias and fnmatch.fnmatchcase(c.name, pattern) for c in commands.values()):
            raise SystemExit('%s:%d: %s has traits or an effect, and is in no record' % (semantics, number, pattern))


def root_aliases(commands):
    """Selects the core name as the root of each group of aliases, because drivers have it in every API."""
    for c in commands.values():
        while c.alias and commands[c.alias].alias:
            c.alias = commands[c.alias].alias
    groups = {}
    for c in commands.values():
        groups.setdefault(c.alias or c.name, []).append(c)
    for root, members in groups.items():
        best = min(members, key=lambda c: (c.feature is None, not c.name.endswith('ARB'), not c.name.endswith('EXT'), len(c.name), c.name))
        for c in members:
            c.alias = None if c is best else best.name
