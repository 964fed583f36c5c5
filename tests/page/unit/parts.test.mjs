import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Scene } from '../../../tools/page/mock/scene.mjs';
import { byteRate, bytes, count, duration, ms, percent } from '../../../tools/page/src/parts/format.ts';
import { changed, kAxisHeight, kRowHeight, labelWidth, rowsOf, spanAt } from '../../../tools/page/src/parts/gantt.ts';
import { parseLog } from '../../../tools/page/src/parts/log_lines.tsx';
import { classForWidth } from '../../../tools/page/src/pictures/picture_hub.ts';
import { codecOf } from '../../../tools/page/src/pictures/video_path.ts';
import { leavesPicture, piecesOf, placeIn, wheelSteps } from '../../../tools/page/src/session/program_input.ts';

test('numbers have units, and missing ones a dash', () => {
    assert.equal(bytes(1234), '1.23 kB');
    assert.equal(bytes(999), '999 B');
    assert.equal(byteRate(2.5e6), '2.50 MB/s');
    assert.equal(ms(0.1234), '0.12 ms');
    assert.equal(percent(0.456), '46 %');
    assert.equal(count(1234567), '1,234,567');
    assert.equal(duration(0.24), '0.2 s');
    assert.equal(duration(3600), '60 min');
    for (const format of [bytes, byteRate, ms, percent, count, duration]) {
        assert.equal(format(NaN), '–');
        assert.equal(format(undefined), '–');
    }
});

test('places are fractions of the element, limited to it', () => {
    const box = { left: 100, top: 50, width: 400, height: 200 };
    assert.deepEqual(placeIn(box, 300, 100), { x: 0.5, y: 0.25 });
    assert.deepEqual(placeIn(box, 0, 900), { x: 0, y: 1 });
});

test('wheels count in 1/120 of a step', () => {
    assert.deepEqual(wheelSteps({ deltaX: 0, deltaY: 100, deltaMode: 0 }), { dx: 0, dy: 120 });
    assert.deepEqual(wheelSteps({ deltaX: -3, deltaY: 1.5, deltaMode: 1 }), { dx: -120, dy: 60 });
    assert.deepEqual(wheelSteps({ deltaX: 0, deltaY: 1e9, deltaMode: 0 }), { dx: 0, dy: 12000 });
});

test('a long text becomes pieces between characters', () => {
    const text = 'ä🙂"\n'.repeat(9000);
    const pieces = piecesOf(text);
    assert.equal(pieces.join(''), text);
    assert.ok(pieces.length > 1);
    for (const piece of pieces) assert.ok(new TextEncoder().encode(JSON.stringify(piece)).length <= 60002);
    assert.deepEqual(piecesOf(''), []);
});

test('Shift F6 leaves the picture', () => {
    assert.ok(leavesPicture({ key: 'F6', shiftKey: true }));
    assert.ok(!leavesPicture({ key: 'F6', shiftKey: false }));
});

test('picture classes follow the width', () => {
    assert.deepEqual([100, 340, 341, 1400, 1401].map(classForWidth), ['thumb', 'thumb', 'preview', 'preview', 'full']);
});

test('the codec is that of the sequence parameter set', () => {
    assert.equal(codecOf(new Uint8Array([0, 0, 0, 1, 9, 16, 0, 0, 0, 1, 0x67, 0x42, 0xc0, 0x1e, 0, 0])), 'avc1.42c01e');
    assert.equal(codecOf(new Uint8Array([1, 2, 3])), 'avc1.42e01f');
});

test('rows follow the way of the data, and points find their spans', () => {
    const reply = new Scene().frames(20);
    const rows = rowsOf(reply.frames, reply.kinds);
    assert.deepEqual(rows.names.map(name => name.split(' ')[0]), ['program', 'head', 'head', 'head', 'head', 'head', 'node', 'node', 'node', 'node']);
    const span = rows.spans.get('node 0 replay').find(entry => entry.kind === 'replay');
    const range = { fromNs: span.beginNs - 1e6, toNs: span.endNs + 1e6 };
    const y = kAxisHeight + (rows.names.indexOf('node 0 replay') + 0.5) * kRowHeight;
    const middle = labelWidth(1000) + (1000 - labelWidth(1000)) / 2;
    assert.equal(spanAt(rows, range, 1000, middle, y), span);
    assert.equal(spanAt(rows, range, 1000, 10, y), null);
    assert.equal(spanAt(rows, range, 1000, middle, 5), null);
});

test('a zoom keeps the place below the pointer', () => {
    const next = changed({ fromNs: 0, toNs: 1e9 }, 0.5, 0.25, 0);
    assert.deepEqual(next, { fromNs: 1.25e8, toNs: 6.25e8 });
    assert.deepEqual(changed({ fromNs: 0, toNs: 1e9 }, 1, 0, 0.1), { fromNs: 1e8, toNs: 1.1e9 });
});

test('logs are JSON or plain text', () => {
    assert.equal(parseLog('[{"atSeconds":1,"topic":"a","level":"info","text":"b"}]')[0].text, 'b');
    assert.equal(parseLog('{"lines":["x","y"]}').length, 2);
    assert.deepEqual(parseLog('one\ntwo\n').map(line => line.text), ['one', 'two']);
});
