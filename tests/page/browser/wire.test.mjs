// Token, roles, first load, loss of the connection, and the decoding of pictures.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open, show, startMock, until, waitForPicture } from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

// Returns the ratio of passed time to processor time of a computation: 1 on an idle machine.
function slowdownOfMachine() {
    const begin = performance.now();
    const cpu = process.cpuUsage();
    for (let sum = 0, i = 0; i < 3e8; ++i) sum += i;
    const { user, system } = process.cpuUsage(cpu);
    return Math.max(1, ((performance.now() - begin) * 1000) / (user + system));
}

async function withMock(options, run) {
    const mock = await startMock(options);
    try {
        await run(mock);
    } finally {
        await mock.close();
    }
}

test('the first load has at most 150 kB, and shows a picture within 1.5 s', () => withMock({}, async mock => {
    const times = [];
    let slowdown = 1;
    // The best of four, on a processor of its own: other work that shares the machine takes its part of the time.
    for (let round = 0; round < 4 && !(Math.min(...times) <= 1500 * slowdown); ++round) {
        mock.bytesOfFirstLoad = 0;
        const { page, close } = await open(browser, mock, { isFresh: true });
        await waitForPicture(page);
        times.push(await page.evaluate(() => performance.getEntriesByName('mural-first-picture')[0].startTime));
        assert.ok(mock.bytesOfFirstLoad > 0 && mock.bytesOfFirstLoad <= 150_000, `${mock.bytesOfFirstLoad} bytes`);
        if (times.at(-1) > 1500) slowdown = Math.max(slowdown, slowdownOfMachine());
        await close();
    }
    console.log(`first load: ${mock.bytesOfFirstLoad} bytes, first picture after ${times.map(Math.round)} ms; other work: ${slowdown.toFixed(1)}`);
    assert.ok(Math.min(...times) <= 1500 * slowdown, `first pictures after ${times} ms, with other work ${slowdown}`);
}));

test('the token leaves the address and is only in the storage of the tab', () => withMock({}, async mock => {
    const { page, close } = await open(browser, mock, { view: 'nodes' });
    await page.waitForSelector('nav a[aria-current][href="#nodes"]');
    assert.equal(page.url(), `${mock.address}#nodes`);
    const stored = await page.evaluate(() => ({ session: { ...sessionStorage }, local: { ...localStorage }, cookie: document.cookie, entries: history.length }));
    assert.deepEqual(stored.session, { 'mural-token': 'operate-token' });
    assert.deepEqual(stored.local, {});
    assert.equal(stored.cookie, '');
    await page.reload();
    await page.waitForSelector('nav a[aria-current][href="#nodes"]');
    await close();
}));

test('an unknown token is refused in words, and another one can be entered', () => withMock({}, async mock => {
    const { page, faults, close } = await open(browser, mock, { token: 'wrong' });
    await page.waitForSelector('.refused');
    assert.match(await page.innerText('.refused'), /unknown, expired or revoked/);
    await page.fill('.refused input', `${mock.address}#t=view-token`);
    await page.click('.refused button');
    await page.waitForSelector('nav a');
    assert.deepEqual(faults, []);
    await close();
}));

test('a view-only link hides operations and input', () => withMock({}, async mock => {
    const { page, faults, close } = await open(browser, mock, { token: 'view-token' });
    await waitForPicture(page);
    assert.deepEqual(await page.$$eval('nav a', links => links.map(link => link.textContent)),
        ['Wall', 'Use', 'Timeline', 'Balance', 'Nodes', 'Network', 'Program']);
    await show(page, 'wall/1');
    await page.waitForSelector('.drawer .facts');
    assert.equal(await page.$('.drawer .buttons button'), null);
    await show(page, 'use');
    await page.waitForSelector('.use .picture');
    assert.equal(await page.$('.use button:text("Take control")'), null);
    await page.evaluate(() => (location.hash = 'links'));
    await page.waitForSelector('text=This link does not manage links.');
    assert.deepEqual(mock.requests.filter(({ op, args }) => args.topic === 'log' || op === 'links'), []);
    assert.deepEqual(faults, []);
    await close();
}));

test('a denied operation is told, and nothing breaks', () => withMock({}, async mock => {
    const { page, faults, close } = await open(browser, mock);
    await show(page, 'balance');
    await page.waitForSelector('button:text("Freeze")');
    for (const client of mock.clients) client.role = 'view';
    await page.click('button:text("Freeze")');
    await page.waitForSelector('.notices .error');
    assert.match(await page.innerText('.notices .error'), /requires the role operate/);
    assert.deepEqual(faults, []);
    await close();
}));

test('after a loss the page says so, greys the last picture, and returns', () => withMock({}, async mock => {
    const { page, close } = await open(browser, mock);
    await waitForPicture(page);
    mock.isRefusing = true;
    mock.drop();
    await page.waitForSelector('.banner.bad');
    assert.match(await page.innerText('.banner.bad'), /No connection to the session/);
    assert.match(await page.$eval('.picture', canvas => getComputedStyle(canvas).filter), /grayscale/);
    await waitForPicture(page, '.picture', 1000);
    await until(async () => /again in [1-9]/.test(await page.innerText('.banner.bad').catch(() => '')), 'a time of the next attempt');
    await new Promise(resolve => setTimeout(resolve, 2500));
    mock.isRefusing = false;
    await page.waitForSelector('.banner.bad', { state: 'detached', timeout: 10000 });
    const frame = await page.$eval('.picture', canvas => Number(canvas.dataset.frame));
    await page.waitForFunction(old => Number(document.querySelector('.picture').dataset.frame) > old, frame);
    await close();
}));

test('pictures are requested only while somebody can see them, in the class of their size', () => withMock({}, async mock => {
    const { page, close } = await open(browser, mock);
    await waitForPicture(page);
    const previews = () => mock.requests.filter(({ op }) => op === 'preview').map(({ args }) => args.class);
    assert.equal(previews().at(-1), 'preview');
    await show(page, 'program');
    await until(() => previews().at(-1) === 'off', 'no picture for the program view');
    await show(page, 'use');
    await page.click('button:text("1:1")');
    await until(() => previews().at(-1) === 'full', 'the full picture at 1:1');
    const size = await page.$eval('.use .picture', canvas => [canvas.width, canvas.height, canvas.clientWidth]);
    await until(async () => (await page.$eval('.use .picture', canvas => canvas.width)) === 1280, `1280 pixels instead of ${size}`);
    assert.ok(mock.acks > 0);
    await close();
}));

// Replaces the decoder: `swallow` is the number of decoders that take units and return nothing.
function patchDecoder(swallow) {
    const Real = window.VideoDecoder;
    window.decoders = [];
    window.VideoDecoder = class {
        static isConfigSupported = config => (Real ? Real.isConfigSupported(config) : Promise.resolve({ supported: true }));
        constructor(init) {
            this.isSilent = window.decoders.length < swallow;
            window.decoders.push(this);
            this.state = 'unconfigured';
            this.real = this.isSilent ? null : new Real(init);
        }
        get decodeQueueSize() { return this.real?.decodeQueueSize ?? 0; }
        configure(config) {
            this.config = config;
            this.state = 'configured';
            this.real?.configure(config);
        }
        decode(unit) { this.real?.decode(unit); }
        close() {
            this.state = 'closed';
            if (this.real && this.real.state !== 'closed') this.real.close();
        }
    };
}

test('H.264 is decoded by WebCodecs', () => withMock({ video: true }, async mock => {
    const { page, faults, close } = await open(browser, mock, { view: 'use' });
    await page.waitForSelector('.use .toolbar:has-text("H.264")', { timeout: 10000 });
    await waitForPicture(page, '.use .picture');
    assert.deepEqual(faults, []);
    await close();
}));

test('a decoder that returns nothing is replaced', () => withMock({ video: true }, async mock => {
    const { page, close } = await open(browser, mock, { view: 'use', before: `(${patchDecoder})(1)` });
    await page.waitForSelector('.use .toolbar:has-text("H.264")', { timeout: 10000 });
    const decoders = await page.evaluate(() => window.decoders.map(({ config, state }) => [config.hardwareAcceleration, state]));
    assert.deepEqual(decoders, [['no-preference', 'closed'], ['prefer-software', 'configured']]);
    assert.ok(mock.requests.filter(({ op, args }) => op === 'preview' && args.class === 'preview').length >= 2, 'a key frame is requested');
    await close();
}));

test('after two silent decoders pictures continue as JPEG', () => withMock({ video: true }, async mock => {
    const { page, close } = await open(browser, mock, { view: 'use', before: `(${patchDecoder})(9)` });
    await page.waitForSelector('.use .toolbar:has-text("JPEG")', { timeout: 12000 });
    assert.equal(await page.evaluate(() => window.decoders.length), 2);
    assert.equal([...mock.clients].at(-1).hello.canUse.h264, false);
    await waitForPicture(page, '.use .picture');
    await close();
}));
