#!/usr/bin/env python3
"""Tests of streamcodec/api/gen: its output for a tiny registry, and properties of its output for the real one.

  generator_test.py            runs the tests
  generator_test.py --update   accepts the present output as golden.txt; read the difference first
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
GEN = os.path.join(ROOT, 'streamcodec', 'api', 'gen')
REAL = os.path.join(ROOT, 'streamcodec', 'api')
GOLDEN = os.path.join(HERE, 'golden.txt')
GL_XML = next((p for p in ('/usr/share/khronos-api/gl.xml', '/usr/share/khronos-api/api/gl.xml') if os.path.exists(p)), None)
GL_XML = os.environ.get('MURAL_GL_XML', GL_XML)
sys.path.insert(0, GEN)
import registry  # noqa: E402


def generate(*options):
    return subprocess.run([sys.executable, os.path.join(GEN, 'generate.py'), *options], capture_output=True, text=True)


def read(path):
    with open(path, encoding='utf-8') as f:
        return f.read()


def write(path, text):
    with open(path, 'w', encoding='utf-8') as f:
        f.write(text)


def tiny(name):
    return os.path.join(HERE, name)


def generated(xml=tiny('gl.xml'), semantics=tiny('semantics.txt'), lock=tiny('opcodes.lock')):
    """Returns all generated files as one text."""
    with tempfile.TemporaryDirectory() as out:
        run = generate('--registry', xml, '--semantics', semantics, '--lock', lock, '--out', out)
        if run.returncode != 0:
            raise AssertionError(run.stderr)
        return ''.join('==== %s\n%s' % (f, read(os.path.join(out, f))) for f in sorted(os.listdir(out)))


class TinyRegistry(unittest.TestCase):
    maxDiff = None

    def test_output_is_as_agreed(self):
        self.assertEqual(read(GOLDEN), generated())

    def test_output_is_the_same_every_time(self):
        self.assertEqual(generated(), generated())

    def test_products_of_counts_are_made_in_64_bits(self):
        self.assertIn('vn(count,16)', generated())
        self.assertNotIn('count*4', generated())

    def test_command_that_is_not_in_the_lock_is_unsupported(self):
        with tempfile.TemporaryDirectory() as folder:
            lock = os.path.join(folder, 'lock')
            names = read(tiny('opcodes.lock'))
            write(lock, names.replace('glVertex2s\n', ''))
            text = generated(lock=lock)
        self.assertIn('{"glVertex2s", "unsupported", "newer than opcodes.lock", false, 0}', text)
        self.assertNotIn('encode_glVertex2s', text)

    def test_update_of_the_lock_only_appends(self):
        with tempfile.TemporaryDirectory() as folder:
            lock = os.path.join(folder, 'lock')
            write(lock, 'glUniform4fv\nglGone\n')
            run = generate('--registry', tiny('gl.xml'), '--semantics', tiny('semantics.txt'), '--lock', lock, '--update-lock')
            self.assertEqual(run.returncode, 0, run.stderr)
            lines = [n for n in read(lock).splitlines() if n[0] != '#']
        self.assertEqual(lines[:2], ['glUniform4fv', 'glGone'])
        self.assertEqual(sorted(lines[2:]), ['glColor3ubv', 'glGenTextures', 'glGetFloatv', 'glOddPointersX', 'glTexImage1D', 'glVertex2s'])

    def rejected(self, text):
        """Returns the generator's error message for these rules."""
        with tempfile.TemporaryDirectory() as folder:
            rules = os.path.join(folder, 'rules')
            write(rules, text)
            run = generate('--registry', tiny('gl.xml'), '--semantics', rules, '--lock', tiny('opcodes.lock'), '--out', folder)
        self.assertNotEqual(run.returncode, 0)
        return run.stderr

    def with_rules(self, text):
        with tempfile.TemporaryDirectory() as folder:
            rules = os.path.join(folder, 'rules')
            write(rules, read(tiny('semantics.txt')) + text)
            return generated(semantics=rules)

    def test_rule_that_matches_nothing_is_an_error(self):
        self.assertIn('rules:1: no command matches glNoSuchCommand', self.rejected('glNoSuchCommand draw\n'))

    def test_traits_of_commands_that_are_never_sent_are_an_error(self):
        self.assertIn('rules:1: glGetFloatv has traits or an effect, and is in no record', self.rejected('glGetFloatv - traits=Matrix\n'))

    def test_traits_of_all_lines_add_up(self):
        self.assertIn('all[op::glVertex2s] = bits(Begin, DrawClass, End, Vertex);', self.with_rules('glVertex2s - traits=End,Begin\n'))

    def test_last_effect_replaces_the_earlier_ones(self):
        text = self.with_rules('glColor* - effect=Cell\n')
        self.assertIn('all[op::glColor3ubv] = {EffectKind::Cell, ObjectType::None, Deferral::ByEffect, 0};', text)

    def test_details_of_effects_follow_the_effect(self):
        text = self.with_rules('glColor3ubv - effect=Cell cell=ClearColor check=Rectangle list=Split\nglVertex2s - list=Split\n')
        self.assertIn('all[op::glColor3ubv].cell = StateCell::ClearColor;', text)
        self.assertIn('all[op::glColor3ubv].check = StateCheck::Rectangle;', text)
        self.assertIn('all[op::glVertex2s].list = ListRole::Split;', text)

    def test_positions_of_arguments_follow_from_the_registry(self):
        text = self.with_rules('glGenTextures - effect=Gen object=Texture\nglUniform4fv - vertices=divisible\n')
        self.assertIn('all[op::glGenTextures].nameNumber = 2;', text)
        self.assertIn('all[op::glUniform4fv].draw = {.count = 1};', text)

    def test_cell_of_command_that_is_never_sent_is_an_error(self):
        self.assertIn('glGetFloatv has traits or an effect', self.rejected('glGetFloatv - cell=ClearColor\n'))

    def test_functions_that_other_wrappers_call_are_loaded(self):
        self.assertNotIn('loadOwnNeeds', generated())
        text = self.with_rules('glGetFloatv - loaded=always\n')
        self.assertIn('void loadOwnNeeds() {\n    static const char* const kNames[] = {\n        "glGetFloatv",\n    };', text)


@unittest.skipUnless(GL_XML, 'no gl.xml here: install khronos-api')
class RealRegistry(unittest.TestCase):
    CLASSES = {'state', 'object', 'draw', 'query', 'sync', 'transfer', 'frame', 'unsupported'}

    @classmethod
    def setUpClass(cls):
        cls.commands, cls.extensions = registry.load(GL_XML, os.path.join(REAL, 'semantics.txt'))
        cls.canonical = [c for c in cls.commands.values() if not c.alias]
        cls.sent = [c for c in cls.canonical if c.sent]
        cls.lock = [n for n in read(os.path.join(REAL, 'opcodes.lock')).splitlines() if n and n[0] != '#']

    def test_every_command_has_a_class(self):
        self.assertGreater(len(self.canonical), 2000)
        self.assertEqual([], [c.name for c in self.canonical if c.command_class not in self.CLASSES])

    def test_every_unsupported_command_has_a_reason(self):
        self.assertEqual([], [c.name for c in self.canonical if c.command_class == 'unsupported' and not c.reason.strip()])

    def test_opcodes_are_unique_and_complete(self):
        self.assertEqual(len(self.lock), len(set(self.lock)))
        self.assertEqual([], [c.name for c in self.canonical if c.name not in set(self.lock)])
        self.assertLess(64 + len(self.lock), 0xffff)

    def test_lock_only_grew(self):
        """The committed lock must be the beginning of the current one."""
        run = subprocess.run(['git', '-C', ROOT, 'show', 'HEAD:streamcodec/api/opcodes.lock'], capture_output=True, text=True)
        if run.returncode != 0:
            self.skipTest('no git history here')
        old = [n for n in run.stdout.splitlines() if n and n[0] != '#']
        self.assertEqual(old, self.lock[:len(old)])

    def test_no_generated_wrapper_writes_to_client_memory(self):
        """Names created by the driver are the only exception: they are encoded after the driver's own call."""
        wrong = [(c.name, p.name) for c in self.sent if c.option('app') != 'custom' for p in c.params
                 if p.pointers and not p.const and p.how != 'made']
        self.assertEqual([], wrong)

    def test_every_parameter_of_a_sent_command_travels(self):
        self.assertEqual([], [(c.name, p.name) for c in self.sent for p in c.params if p.how is None])

    def test_no_size_multiplies_in_32_bits(self):
        wrong = [(c.name, p.expr) for c in self.sent for p in c.params if p.how == 'array' and re.search(r'\w\*\d|\d\*\w', str(p.expr))]
        self.assertEqual([], wrong)

    def test_arrays_of_names_are_as_long_as_they_are_read(self):
        """replay_.names() reads `length` names, so the checked size must be four bytes per name."""
        wrong = [(c.name, p.expr) for c in self.sent for p in c.params if p.how == 'array' and p.kind and p.length
                 and p.expr not in ('vn(%s,4)' % p.length, 'n4(%s,%s)' % (p.length, p.name))]
        self.assertEqual([], wrong)

    def test_core_commands_are_supported_or_explained(self):
        """No command of a core version is unsupported because of a parsing error."""
        vague = ('is not described', 'its return value', 'is unknown')
        wrong = [(c.name, c.reason) for c in self.canonical if c.feature and c.command_class == 'unsupported' and any(v in c.reason for v in vague)]
        self.assertEqual([], wrong)

    def test_draws_without_a_quiet_call_are_vertices(self):
        """Without `quiet` the program's own context skips the command in contexts with glBegin. Only vertices permit that."""
        wrong = [c.name for c in self.sent if c.command_class == 'draw' and c.option('app') != 'custom' and not c.option('quiet') and 'Vertex' not in c.traits]
        self.assertEqual([], wrong)

    def test_copies_out_of_framebuffers_gather_what_they_read(self):
        """No driver here has the imaging subset, so it is not gathered. glAccum and pixel copies have hand-written wrappers."""
        imaging = re.compile(r'glCopy(Color|Convolution)')
        wrong = [c.name for c in self.sent if ('ReadsFramebuffer' in c.traits) != bool(c.option('copies'))
                 and 'Pixels' not in c.traits and not imaging.match(c.name)]
        self.assertEqual([], wrong)

    def test_aliases_lead_to_commands_that_have_a_class(self):
        for c in self.commands.values():
            if c.alias:
                self.assertIsNone(self.commands[c.alias].alias, c.name)


if __name__ == '__main__':
    if sys.argv[1:] == ['--update']:
        write(GOLDEN, generated())
    else:
        unittest.main()
