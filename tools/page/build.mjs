// Bundles the page: one HTML, one script, one style sheet, one icon. Usage: node build.mjs [--out FOLDER] [--budget BYTES]
// Fails if the compressed files exceed the budget.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { build } from 'esbuild';

const folder = dirname(fileURLToPath(import.meta.url));

function option(name, fallback) {
    const at = process.argv.indexOf(name);
    return at < 0 ? fallback : process.argv[at + 1];
}

const out = resolve(option('--out', join(folder, 'dist')));
const budget = Number(option('--budget', 150_000));

const { outputFiles } = await build({
    entryPoints: [join(folder, 'src/main.tsx')],
    absWorkingDir: folder,
    bundle: true,
    minify: true,
    format: 'iife',
    target: ['chrome100', 'firefox110', 'safari16'],
    jsx: 'automatic',
    jsxImportSource: 'preact',
    legalComments: 'none',
    charset: 'utf8',
    outfile: join(out, 'page.js'),
    write: false,
    logLevel: 'warning',
});

const files = new Map(outputFiles.map(file => [file.path.split('/').pop(), Buffer.from(file.contents)]));
for (const name of ['index.html', 'icon.svg']) files.set(name, readFileSync(join(folder, 'src', name)));
mkdirSync(out, { recursive: true });
let compressed = 0;
for (const [name, bytes] of files) {
    writeFileSync(join(out, name), bytes);
    compressed += gzipSync(bytes, { level: 9 }).length;
}
console.log(`page: ${[...files.keys()].sort().join(', ')}; ${compressed} bytes compressed`);
if (compressed > budget) {
    console.error(`page: ${compressed} bytes exceed the budget of ${budget} bytes`);
    process.exit(1);
}
