import assert from 'node:assert/strict';
import { test } from 'node:test';
import { retryDelayMs, socketAddress } from '../../../tools/page/src/wire/connection.ts';
import { parsePictureMessage } from '../../../tools/page/src/wire/picture_message.ts';
import { tokenOf } from '../../../tools/page/src/wire/token.ts';

function message(members, payload) {
    const bytes = new Uint8Array(36 + payload.length);
    const view = new DataView(bytes.buffer);
    view.setUint8(0, members.version ?? 1);
    view.setUint8(1, 2);
    view.setUint16(2, 3, true);
    view.setUint32(4, 5, true);
    view.setBigUint64(8, 2n ** 40n + 7n, true);
    view.setUint32(16, 99, true);
    [10, 20, 30, 40, 640, 360].forEach((value, i) => view.setUint16(20 + 2 * i, value, true));
    view.setUint32(32, members.bytes ?? payload.length, true);
    bytes.set(payload, 36);
    return bytes;
}

test('a picture message has all of its parts', () => {
    const one = message({}, [1, 2, 3]);
    const both = new Uint8Array([...one, ...message({}, [])]);
    const parts = parsePictureMessage(both.buffer);
    assert.equal(parts.length, 2);
    const { payload, ...rest } = parts[0];
    assert.deepEqual([...payload], [1, 2, 3]);
    assert.deepEqual(rest, {
        kind: 2, isKeyFrame: true, isLast: true, isStill: false, isHidden: false, stream: 5, frame: 2 ** 40 + 7, lastInput: 99,
        x: 10, y: 20, width: 30, height: 40, pictureWidth: 640, pictureHeight: 360,
    });
});

test('damaged picture messages are RangeErrors', () => {
    assert.throws(() => parsePictureMessage(message({ version: 2 }, []).buffer), RangeError);
    assert.throws(() => parsePictureMessage(message({ bytes: 4 }, [1, 2, 3]).buffer), RangeError);
    assert.throws(() => parsePictureMessage(message({}, []).buffer.slice(0, 35)), RangeError);
    let seed = 1;
    for (let round = 0; round < 5000; ++round) {
        const bytes = message({}, [1, 2, 3, 4]);
        for (let i = 0; i < 3; ++i) {
            seed = (seed * 1103515245 + 12345) % 2147483648;
            bytes[seed % bytes.length] = seed >> 8;
        }
        try {
            parsePictureMessage(bytes.buffer);
        } catch (error) {
            assert.ok(error instanceof RangeError);
        }
    }
});

test('the WebSocket is beside the page, below any prefix', () => {
    assert.equal(socketAddress('http://127.0.0.1:8787/#wall'), 'ws://127.0.0.1:8787/ws');
    assert.equal(socketAddress('https://portal/node/a/8787/?x=1#use/2'), 'wss://portal/node/a/8787/ws');
});

test('delays between attempts grow to 15 s', () => {
    const delays = [0, 1, 2, 3, 4, 5, 100].map(retryDelayMs);
    assert.deepEqual(delays, [500, 1000, 2000, 4000, 8000, 15000, 15000]);
});

test('a token is the text or a part of an address', () => {
    assert.equal(tokenOf(' abc_-1 '), 'abc_-1');
    assert.equal(tokenOf('http://127.0.0.1:8787/#t=abc_-1'), 'abc_-1');
});
