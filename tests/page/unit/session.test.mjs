import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { Scene } from '../../../tools/page/mock/scene.mjs';
import { conditionOf, headline, outputCondition, reasonOf } from '../../../tools/page/src/session/condition.ts';
import { parseEqc } from '../../../tools/page/src/session/eqc_tree.ts';
import { FrameStore, summarize } from '../../../tools/page/src/session/frame_store.ts';
import { History } from '../../../tools/page/src/session/history.ts';
import { frameOf, partOf, percentOf } from '../../../tools/page/src/session/wall_geometry.ts';

const copy = value => JSON.parse(JSON.stringify(value));

function status(atSeconds, frames, replaySeconds) {
    return {
        session: 's', atSeconds, frames, programs: [], nodes: replaySeconds.map((seconds, node) => ({
            node, state: 'alive', silentSeconds: 0, frames, replaySeconds: seconds, readbackSeconds: 0, pictureBytes: 1000 * frames, pictureRawBytes: 0,
        })),
    };
}

test('rates are differences of two states', () => {
    const history = new History();
    history.add(status(10, 100, [1, 1]));
    history.add(status(12, 150, [1.5, 1.1]));
    const { framesPerSecond, nodes } = history.latest;
    assert.equal(framesPerSecond, 25);
    assert.ok(Math.abs(nodes.get(0).replayMs - 10) < 1e-9);
    assert.ok(Math.abs(nodes.get(1).replayMs - 2) < 1e-9);
    assert.equal(nodes.get(0).pictureBytes, 25000);
});

test('a restarted node counts from zero, and the history is bounded', () => {
    const history = new History();
    history.add(status(10, 100, [9]));
    history.add(status(11, 10, [0.1]));
    assert.ok(Math.abs(history.latest.nodes.get(0).replayMs - 10) < 1e-9);
    for (let i = 0; i < 2000; ++i) history.add(status(12 + i, 10 + i, [0.1]));
    assert.equal(history.rates.length, 300);
});

test('conditions name lost, slow and silent nodes', () => {
    const history = new History();
    history.add(status(10, 100, [1, 1, 1]));
    const now = status(11, 110, [1.05, 1.2, 1.06]);
    history.add(now);
    const words = () => now.nodes.map(node => conditionOf(node, history.latest).word);
    assert.deepEqual(words(), ['alive', 'slow', 'alive']);
    now.programs = [{}];
    assert.deepEqual(headline(now, history.latest), { mark: 'warn', word: 'node 1 slow' });
    assert.equal(reasonOf(now.nodes[1], history.latest, [], []), 'Replay takes 20.0 ms per frame; the median of the other nodes is 6.00 ms.');
    now.nodes[2].silentSeconds = 4;
    now.nodes[0].state = 'lost';
    assert.deepEqual(words(), ['lost', 'slow', 'silent']);
    assert.equal(headline(now, history.latest).word, 'node 0 lost');
    const text = 'node 0 (wall1, pid 7) was lost: signal 9';
    assert.equal(reasonOf(now.nodes[0], null, [{ event: 'node-lost', node: 0, text }], []), text);
    assert.equal(reasonOf(now.nodes[0], null, [], [{ text: 'node 01 was lost' }, { text }]), text);
    assert.equal(outputCondition({ ageSeconds: 1 }, 0).word, 'live');
    assert.equal(outputCondition({ ageSeconds: 1 }, 2.5).word, 'frozen');
    assert.equal(outputCondition(undefined, 9), null);
});

test('the summary names the slowest stage of recorded frames', () => {
    const scene = new Scene();
    scene.isSlow = true;
    const reply = scene.frames(200);
    const summary = summarize(reply.frames, reply.kinds);
    assert.equal(summary.frames, 200);
    assert.equal(summary.slowest.kind, 'replay');
    assert.equal(`${summary.slowest.process} ${summary.slowest.number}`, 'node 2');
    assert.ok(summary.frameMs > 10 && summary.frameMs < 100);
});

test('the store of frames merges replies, and keeps 600', () => {
    const scene = new Scene();
    const store = new FrameStore();
    const first = scene.frames(100);
    store.add(first);
    store.add(copy(first));
    assert.equal(store.frames.length, 100);
    for (let i = 0; i < 20; ++i) store.add(scene.frames(50));
    assert.equal(store.frames.length, 600);
    assert.deepEqual(store.frames.map(frame => frame.number), Array.from({ length: 600 }, (_, i) => 501 + i));
    // Another session begins with 1.
    store.add(new Scene().frames(10));
    assert.equal(store.frames.length, 10);
});

test('segments keep their places in millimetres', () => {
    const [canvas] = new Scene().wall().canvases;
    const frame = frameOf(canvas);
    assert.deepEqual(frame, [0, 0, 1240, 720]);
    assert.deepEqual(percentOf([620, 360, 620, 360], frame), { left: '50%', top: '50%', width: '50%', height: '50%' });
    assert.deepEqual(partOf({ rectPx: [640, 0, 640, 360] }, canvas), [0.5, 0, 0.5, 0.5]);
});

test('all configurations of the tree become trees with one server', () => {
    const folder = new URL('../../../configs/', import.meta.url);
    const names = readdirSync(folder).filter(name => name.endsWith('.eqc'));
    assert.ok(names.length > 10);
    for (const name of names) {
        const tree = parseEqc(readFileSync(new URL(name, folder), 'utf8'));
        const server = tree.find(node => node.name === 'server');
        assert.ok(server && server.children.some(child => child.name === 'config'), name);
    }
    const [node] = parseEqc('node { host "wänd" pipe { device 0 window { viewport [ 0 0 .5 1 ] hint ON } } }');
    assert.deepEqual(node.children[0], { name: 'host', values: ['"wänd"'], children: [] });
    assert.deepEqual(node.children[1].children[1].children, [
        { name: 'viewport', values: ['[ 0 0 .5 1 ]'], children: [] }, { name: 'hint', values: ['ON'], children: [] },
    ]);
    assert.ok(parseEqc('a { b { '.repeat(3000)).length === 1);
});
