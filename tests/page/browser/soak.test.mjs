// Many hours of messages, compressed in time. MURAL_PAGE_HOURS in the environment: their number, default 10.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kAllViews, launch, open, startMock, until } from './browser.mjs';

const kHours = Number(process.env.MURAL_PAGE_HOURS ?? 10);
let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

// Per hour: a state per second, its events, log lines and outputs, and frames of the timeline.
test('hours of messages leave the memory of the page stable', async () => {
    const quiet = await startMock({ isQuiet: true });
    try {
        const { page, faults, close } = await open(browser, quiet, { view: 'timeline' });
        await page.waitForSelector('nav a[aria-current][href="#timeline"]');
        await until(() => [...quiet.clients][0]?.topics.has('timeline'), 'the subscription');
        const [client] = quiet.clients;
        const send = (topic, makeData) => {
            if (client.topics.has(topic)) client.web.send(JSON.stringify({ topic, dropped: 0, data: makeData() }));
        };
        const hours = async many => {
            for (let second = 0; second < many * 3600; ++second) {
                quiet.scene.step(1);
                send('status', () => (quiet.scene.status));
                send('outputs', () => (quiet.scene.outputs()));
                if (second % 4 === 0) send('timeline', () => (quiet.scene.frames(4)));
                if (second % 10 === 0) send('log', () => [{ atSeconds: second, topic: 'node', level: 'info', text: `line ${second}` }]);
                if (second % 20 === 0) send('events', () => [{ event: 'node-joined', node: 1, joins: second }]);
                // Views open and close meanwhile. The page reads its messages before the next ones.
                if (second % 600 === 0) {
                    await page.evaluate(view => (location.hash = view), kAllViews[(second / 600) % kAllViews.length]);
                    await until(() => client.web.bufferedAmount === 0, 'the page reads', 60000);
                    await page.waitForTimeout(20);
                }
            }
        };
        const heap = async () => {
            await page.evaluate(() => (location.hash = 'timeline'));
            await page.waitForTimeout(300);
            for (let i = 0; i < 3; ++i) await page.evaluate(() => window.gc());
            const elements = await page.evaluate(() => document.querySelectorAll('*').length);
            return { bytes: await page.evaluate(() => performance.memory.usedJSHeapSize), elements };
        };
        await hours(1);
        const early = await heap();
        await hours(kHours - 1);
        const late = await heap();
        console.log(`heap after 1 h: ${early.bytes} bytes, after ${kHours} h: ${late.bytes} bytes`);
        // The collector leaves 6 to 22 MB, whatever came before. Two hours of kept states occupy more than 30 MB.
        assert.ok(late.bytes < early.bytes + 22e6, `${early.bytes} → ${late.bytes} bytes`);
        assert.ok(late.elements < early.elements * 1.3 + 50, `${early.elements} → ${late.elements} elements`);
        assert.deepEqual(faults, []);
        await close();
    } finally {
        await quiet.close();
    }
});
