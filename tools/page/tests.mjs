// Runs the page's unit tests with the test runner of node: node tests.mjs [FILE...]
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const folder = dirname(fileURLToPath(import.meta.url));
const tests = resolve(folder, '../../tests/page/unit');
const wanted = process.argv.slice(2);
const files = readdirSync(tests).filter(name => name.endsWith('.test.mjs') && (!wanted.length || wanted.includes(name)));
const out = mkdtempSync(join(tmpdir(), 'mural-page-tests-'));
try {
    // esbuild translates the TypeScript that the tests import. The mock reads files beside it, so it stays outside of the bundle.
    const mock = {
        name: 'mock',
        setup: ({ onResolve }) => onResolve({ filter: /\/mock\// }, ({ path, resolveDir }) => ({ path: resolve(resolveDir, path), external: true })),
    };
    await build({
        entryPoints: files.map(name => join(tests, name)), bundle: true, platform: 'node', format: 'esm', outdir: out,
        outExtension: { '.js': '.mjs' }, nodePaths: [join(folder, 'node_modules')], jsx: 'automatic', jsxImportSource: 'preact',
        logLevel: 'warning', plugins: [mock], define: { 'import.meta.url': JSON.stringify('file://' + tests + '/') },
    });
    const result = spawnSync(process.execPath, ['--test', ...readdirSync(out).map(name => join(out, name))], { stdio: 'inherit' });
    process.exitCode = result.status ?? 1;
} finally {
    rmSync(out, { recursive: true });
}
