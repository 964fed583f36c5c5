#!/usr/bin/env python3
"""The packages work in a new Debian 12: apt installs them, a user draws a wall, and purge leaves nothing.

  fresh_root.py            runs only with MURAL_TEST_PACKAGES=1, as root, with a mirror of Debian: it takes minutes
  MURAL_PACKAGES=DIR       folder of the packages; default: tools/package builds them
  MURAL_FRESH_ROOT=FILE    tar file of a root of mmdebstrap --variant=apt; default: made once in build/package
"""
import glob
import os
import pwd
import shutil
import subprocess
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SKIPPED = 77
STEP_LIMIT_S = 900

# Mounts that a chroot needs, in a namespace of its own: nothing of it remains.
ENTER = """set -e
root=$1; shift
mount --bind "$root" "$root"
mount -t proc proc "$root/proc"
mount -t tmpfs -o mode=755 tmpfs "$root/dev"
mkdir "$root/dev/shm" "$root/dev/pts"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
ln -s pts/ptmx "$root/dev/ptmx"
ln -s /proc/self/fd "$root/dev/fd"
for device in null zero full random urandom tty; do touch "$root/dev/$device"; mount --bind "/dev/$device" "$root/dev/$device"; done
exec chroot "$root" "$@"
"""
# Files of apt, dpkg and the shared caches that every installation changes.
CHANGED = ('/var/cache/', '/var/log/', '/var/lib/apt/', '/var/lib/dpkg/', '/etc/ld.so.cache', '/tmp/', '/home/', pwd.getpwuid(0).pw_dir + '/', '/proc/', '/dev/', '/sys/', '/run/')

failures = []
measured = []


def expect(holds, what):
    if not holds:
        failures.append(what)


class Root:
    """A Debian in a folder. Commands run in namespaces of their own, and end with them."""

    def __init__(self, folder, archive):
        self.folder = folder
        subprocess.run(['tar', '-x', '-f', archive, '-C', folder, '--exclude=./dev/*'], check=True, timeout=STEP_LIMIT_S)
        shutil.copy('/etc/resolv.conf', os.path.join(folder, 'etc/resolv.conf'))

    def run(self, what, script, user=None):
        """Runs a script, and returns its status and output."""
        start = time.monotonic()
        words = ['setpriv', '--reuid', user, '--regid', user, '--clear-groups', '--reset-env'] if user else []
        done = subprocess.run(['unshare', '--mount', '--pid', '--fork', '--kill-child', 'sh', '-c', ENTER, 'sh', self.folder, *words, 'bash', '-c', script],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=STEP_LIMIT_S,
                              env=dict(os.environ, DEBIAN_FRONTEND='noninteractive', LC_ALL='C.UTF-8', PATH='/usr/sbin:/usr/bin:/sbin:/bin'))
        measured.append('%-34s %6.1f s' % (what, time.monotonic() - start))
        return done.returncode, done.stdout

    def require(self, what, script, user=None):
        status, out = self.run(what, script, user)
        if status != 0:
            raise SystemExit('%s: status %d\n%s' % (what, status, out[-3000:]))
        return out

    def files(self):
        found = set()
        for folder, _, names in os.walk(self.folder):
            inside = folder[len(self.folder):]
            found.update(path for path in (inside + '/' + name for name in names) if not path.startswith(CHANGED))
        return found


def packages():
    folder = os.environ.get('MURAL_PACKAGES')
    if not folder:
        subprocess.run([os.path.join(TOP, 'tools', 'package')], check=True, timeout=3600)
        folder = os.path.join(TOP, 'build', 'package', 'packages')
    found = sorted(path for path in glob.glob(os.path.join(folder, '*.deb')) if 'dbgsym' not in path)
    if not any(os.path.basename(path).startswith('mural_') for path in found):
        raise SystemExit('%s has no package of mural; run tools/package' % folder)
    return found


def archive():
    path = os.environ.get('MURAL_FRESH_ROOT', os.path.join(TOP, 'build', 'package', 'bookworm.tar'))
    if not os.path.exists(path):
        os.makedirs(os.path.dirname(path), exist_ok=True)
        subprocess.run(['mmdebstrap', '--variant=apt', '--format=tar', 'bookworm', path + '.new'], check=True, timeout=3600)
        os.rename(path + '.new', path)
    return path


def check_installed(root):
    listed = root.require('files of the package', 'dpkg -L mural').split()
    expect(any(path.endswith('/mural/libGLX_mural.so.0') for path in listed), 'the capture library is not in a folder of its own')
    expect('mural' not in root.require('libraries of the loader', 'ldconfig -p'), 'the loader finds libraries of Mural by itself')
    size = int(root.require('installed size', "dpkg-query -W -f '${Installed-Size}' mural"))
    measured.append('%-34s %6d KiB' % ('installed size of mural', size))
    expect(size <= 40 * 1024, 'mural has %d KiB; at most 40 MiB' % size)
    details = root.require('version --verbose', 'mural version --verbose', '1000')
    expect('(missing)' not in details and '/usr/lib/x86_64-linux-gnu/mural/libGLX_mural.so.0' in details, details)
    manual = root.require('man mural-run', 'man mural-run | cat', '1000')
    expect('--tiles' in manual and 'EXIT STATUS' in manual, 'man mural-run: %s' % manual[:500])
    status, out = root.run('doctor', 'mural doctor', '1000')
    expect(status == 0, 'mural doctor: status %d\n%s' % (status, out))
    completed = root.require('completion', """source /usr/share/bash-completion/bash_completion
        COMP_WORDS=(mural run --tilin) COMP_CWORD=2 COMP_LINE='mural run --tilin' COMP_POINT=17
        _completion_loader mural; _mural; echo "${COMPREPLY[@]}" """, '1000')
    expect(completed.strip() == '--tiling', 'completion: %s' % completed)


def check_wall(root):
    out = root.require('wall of glxgears', 'cd && mural run --tiles 2x2 --frames 30 --out shots -- glxgears 2>&1 && ls shots | wc -l', '1000')
    expect(out.strip().split('\n')[-1] == '30', 'glxgears: %s' % out[-800:])
    out = root.require('exactness of glxgears', 'cd && mural run --tiles 2x2 --frames 10 --display none --verify -- glxgears 2>&1', '1000')
    expect(': 0 differ' in out, 'glxgears --verify: %s' % out[-800:])
    out = root.require('EGL program', 'cd && mural run --frames 5 --out egl -- es2gears_x11 2>&1 && ls egl | wc -l', '1000')
    expect(out.strip().split('\n')[-1] == '5', 'es2gears_x11: %s' % out[-800:])


def main():
    if os.environ.get('MURAL_TEST_PACKAGES') != '1':
        print('set MURAL_TEST_PACKAGES=1 to install the packages in a new Debian, which takes minutes')
        return SKIPPED
    if os.geteuid() != 0:
        print('needs root for a new Debian')
        return SKIPPED
    debs = packages()
    with tempfile.TemporaryDirectory(prefix='mural-root.') as folder:
        os.chmod(folder, 0o755)
        root = Root(folder, archive())
        root.require('apt update', 'apt-get -q update && useradd --create-home --uid 1000 user')
        for path in debs:
            shutil.copy(path, os.path.join(folder, 'tmp'))
        root.require('programs of the test', 'apt-get -q -y install --no-install-recommends bash-completion man-db')
        before = root.files()
        root.require('apt install mural', 'cd /tmp && apt-get -q -y install ./mural_*.deb')
        root.require('apt install mesa-utils', 'apt-get -q -y install --no-install-recommends mesa-utils')
        check_installed(root)
        check_wall(root)
        root.require('apt install libmural-dev', 'cd /tmp && apt-get -q -y install --no-install-recommends ./libmural*.deb')
        root.require('reinstall', 'cd /tmp && apt-get -q -y install --reinstall ./mural_*.deb')
        root.require('apt purge', 'apt-get -q -y purge mural libmural0 libmural-dev && apt-get -q -y autoremove --purge')
        left = sorted(path for path in root.files() - before if 'mural' in path)
        expect(not left, 'purge leaves %s' % left)
        expect(root.run('dpkg -s', 'dpkg-query -W mural')[0] != 0, 'dpkg still has mural')
    for line in measured:
        print(line)
    for failure in failures:
        print(failure)
    print('%d failures' % len(failures))
    return 1 if failures else 0


sys.exit(main())
