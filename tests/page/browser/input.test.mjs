// Input to the program: control, places of the pointer, wheel, keys, touch and text.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kPhone, launch, open, startMock, until, waitForPicture } from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

async function inControl(options, run) {
    const mock = await startMock();
    try {
        const { page, faults, close } = await open(browser, mock, { view: 'use', ...options });
        await waitForPicture(page, '.use .picture');
        await page.click('button:text("Take control")');
        await page.waitForSelector('.surface.active');
        mock.inputs.length = 0;
        await run({ mock, page });
        assert.deepEqual(faults, []);
        await close();
    } finally {
        await mock.close();
    }
}

const ofKind = (mock, kind) => mock.inputs.filter(input => input.kind === kind);
const boxOf = page => page.$eval('.surface .picture', canvas => canvas.getBoundingClientRect().toJSON());

test('the pointer maps within one pixel of the program', () => inControl({}, async ({ mock, page }) => {
    for (const isOneToOne of [false, true]) {
        if (isOneToOne) {
            await page.click('button:text("1:1")');
            await page.waitForFunction(() => document.querySelector('.surface .picture').width === 1280);
        }
        const box = await boxOf(page);
        const limits = await page.$eval('.use-area', area => area.getBoundingClientRect().toJSON());
        let seed = 7;
        const random = () => (seed = (seed * 1103515245 + 12345) % 2147483648) / 2147483648;
        for (let i = 0; i < 6; ++i) {
            const x = Math.round(Math.max(box.x, limits.x) + 2 + random() * (Math.min(box.right, limits.right) - Math.max(box.x, limits.x) - 20));
            const y = Math.round(Math.max(box.y, limits.y) + 2 + random() * (Math.min(box.bottom, limits.bottom, 710) - Math.max(box.y, limits.y) - 20));
            mock.inputs.length = 0;
            await page.mouse.move(x, y);
            await page.mouse.down();
            await page.mouse.up();
            await until(() => ofKind(mock, 'up').length === 1, 'an event of the button');
            const [down] = ofKind(mock, 'down');
            assert.ok(Math.abs(down.x * 1280 - ((x - box.x) / box.width) * 1280) <= 1, `${down.x} for ${x}`);
            assert.ok(Math.abs(down.y * 720 - ((y - box.y) / box.height) * 720) <= 1, `${down.y} for ${y}`);
            assert.equal(down.button, 1);
        }
    }
}));

test('moves, buttons and wheels arrive in order, with increasing numbers', () => inControl({}, async ({ mock, page }) => {
    const box = await boxOf(page);
    await page.mouse.move(box.x + 50, box.y + 50);
    await page.mouse.down({ button: 'right' });
    await page.mouse.move(box.x + 250, box.y + 150, { steps: 8 });
    await page.mouse.up({ button: 'right' });
    await page.mouse.wheel(0, -200);
    await until(() => ofKind(mock, 'wheel').length > 0, 'the wheel');
    const kinds = mock.inputs.map(input => input.kind).filter(kind => kind !== 'move');
    assert.deepEqual(kinds, ['down', 'up', 'wheel']);
    assert.equal(ofKind(mock, 'down')[0].button, 3);
    assert.equal(ofKind(mock, 'wheel')[0].dy, -240);
    const at = mock.inputs.findIndex(input => input.kind === 'up');
    assert.equal(mock.inputs[at - 1].kind, 'move', 'the last move precedes the release');
    const numbers = mock.inputs.map(input => input.seq);
    assert.deepEqual(numbers, [...numbers].sort((a, b) => a - b));
    for (const { x, y } of mock.inputs) assert.ok(x >= 0 && x <= 1 && y >= 0 && y <= 1);
}));

test('keys go to the program, also Tab and shortcuts, and Shift F6 leaves', () => inControl({}, async ({ mock, page }) => {
    await page.focus('.surface');
    for (const key of ['a', 'Tab', 'Control+s', 'ArrowUp', 'é']) await page.keyboard.press(key).catch(() => page.keyboard.insertText(key));
    await until(() => ofKind(mock, 'key').filter(input => input.key === 'ArrowUp').length === 2, 'the arrow key');
    const keys = ofKind(mock, 'key').map(input => `${input.down ? '+' : '-'}${input.key}`);
    assert.deepEqual(keys.slice(0, 10), ['+a', '-a', '+Tab', '-Tab', '+Control', '+s', '-s', '-Control', '+ArrowUp', '-ArrowUp']);
    assert.equal(ofKind(mock, 'key')[0].code, 'KeyA');
    assert.ok(await page.evaluate(() => document.activeElement.classList.contains('surface')), 'Tab stays in the picture');
    await page.keyboard.press('Shift+F6');
    assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Release control');
    await until(() => ofKind(mock, 'blur').length === 1, 'all keys are released');
    assert.ok(!ofKind(mock, 'key').some(input => input.key === 'F6'));
}));

test('the desktop shows the display of the program, and takes its own places', () => inControl({}, async ({ mock, page }) => {
    const [client] = mock.clients;
    await page.click('button:text("Desktop")');
    await until(() => client.previews.get('desktop') && client.previews.get('desktop') !== 'off' && client.previews.get('wall') === 'off', 'the request for the desktop');
    await page.waitForFunction(() => document.querySelector('[aria-label="Display of the program"]')?.dataset.frame > 0);
    const box = await boxOf(page);
    mock.inputs.length = 0;
    await page.mouse.click(box.x + box.width / 4, box.y + box.height / 2);
    await until(() => ofKind(mock, 'up').length === 1, 'an event of the button');
    const [down] = ofKind(mock, 'down');
    assert.equal(down.of, 'desktop');
    assert.ok(Math.abs(down.x - 0.25) < 0.01 && Math.abs(down.y - 0.5) < 0.01, `${down.x}, ${down.y}`);
    await page.click('button:text("Desktop")');
    await until(() => client.previews.get('wall') !== 'off' && client.previews.get('desktop') === 'off', 'the wall again');
    mock.inputs.length = 0;
    await page.mouse.click(box.x + 20, box.y + 20);
    await until(() => ofKind(mock, 'down').length === 1, 'an event of the wall');
    assert.equal(ofKind(mock, 'down')[0].of, undefined);
}));

test('text is pasted and typed', () => inControl({}, async ({ mock, page }) => {
    await page.fill('.paste input', 'Grüße 🙂 "a"');
    await page.click('.paste button');
    await until(() => ofKind(mock, 'text').length === 1, 'the text');
    assert.equal(ofKind(mock, 'text')[0].text, 'Grüße 🙂 "a"');
    await page.$eval('.surface', surface => {
        surface.focus();
        const data = new DataTransfer();
        data.setData('text/plain', 'from the clipboard');
        surface.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true, cancelable: true }));
    });
    await until(() => ofKind(mock, 'text').length === 2, 'the clipboard');
    assert.equal(ofKind(mock, 'text')[1].text, 'from the clipboard');
}));

test('a finger is a touch, and a long press the right button', () => inControl({ viewport: kPhone }, async ({ mock, page }) => {
    const box = await boxOf(page);
    await page.touchscreen.tap(box.x + box.width / 4, box.y + box.height / 2);
    await until(() => ofKind(mock, 'touch').length === 2, 'a tap');
    const [down, up] = ofKind(mock, 'touch');
    assert.deepEqual([down.down, up.down], [true, false]);
    assert.ok(Math.abs(down.x * 1280 - 320) <= 2 * (1280 / box.width) && Math.abs(down.y * 720 - 360) <= 2 * (720 / box.height));
    const client = await page.context().newCDPSession(page);
    const point = { x: box.x + 100, y: box.y + 60 };
    await client.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [point] });
    await until(() => ofKind(mock, 'down').length === 1, 'a long press');
    assert.equal(ofKind(mock, 'down')[0].button, 3);
    await client.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
}));

test('one viewer has control, and all see who', () => inControl({}, async ({ mock, page }) => {
    const other = await open(browser, mock, { view: 'use', token: 'input-token' });
    await other.page.waitForSelector('.holder:text("has control")');
    assert.match(await other.page.innerText('.holder'), /^Chrome on Linux has control/);
    assert.equal(await page.innerText('.holder'), 'You have control.');
    await other.page.click('button:text("Take control")');
    await page.waitForSelector('button:text("Take control")');
    await until(async () => (await other.page.innerText('.holder')) === 'You have control.', 'the hand-over');
    mock.inputs.length = 0;
    const box = await boxOf(page);
    await page.mouse.click(box.x + 20, box.y + 20);
    await new Promise(resolve => setTimeout(resolve, 300));
    assert.deepEqual(mock.inputs.filter(input => input.kind !== 'blur'), [], 'the former holder sends nothing');
    await other.close();
}));

test('the time from input to picture is shown', () => inControl({}, async ({ mock, page }) => {
    const box = await boxOf(page);
    for (let i = 0; i < 5; ++i) {
        await page.mouse.click(box.x + 20 + 9 * i, box.y + 20);
        await new Promise(resolve => setTimeout(resolve, 120));
    }
    await page.waitForSelector('.toolbar:has-text("input to picture")', { timeout: 5000 });
    assert.ok(mock.inputs.length >= 10);
}));

const kShape = Buffer.from('iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==', 'base64');
const cursorBox = page => page.$eval('.program-cursor', canvas => ({ hidden: canvas.hidden, ...canvas.getBoundingClientRect().toJSON() }));

test('the pointer has the shape of the program, and follows the hand at once', () => inControl({}, async ({ mock, page }) => {
    const box = await boxOf(page);
    await page.mouse.move(box.x + 200, box.y + 100);
    mock.sendCursor(kShape, [0.9, 0.9], [3, 5]);
    await page.waitForSelector('.surface.has-cursor');
    await page.mouse.move(box.x + 201, box.y + 101);
    const own = await cursorBox(page);
    assert.ok(Math.abs(own.x - (box.x + 198)) <= 1 && Math.abs(own.y - (box.y + 96)) <= 1, JSON.stringify([own, box]));
    assert.equal(await page.$eval('.surface', element => getComputedStyle(element).cursor), 'none');
}));

test('viewers see the pointer where the program has it', async () => {
    const mock = await startMock();
    const { page, faults, close } = await open(browser, mock, { view: 'use', token: 'view-token' });
    await waitForPicture(page, '.use .picture');
    assert.equal((await cursorBox(page)).hidden, true);
    mock.sendCursor(kShape, [0.5, 0.25], [3, 5]);
    mock.sendCursor(Buffer.alloc(0), [0.25, 0.5], [3, 5]);
    const box = await boxOf(page);
    await until(async () => Math.abs((await cursorBox(page)).x - (box.x + box.width / 4 - 3)) <= 1, 'the place of the pointer');
    assert.ok(Math.abs((await cursorBox(page)).y - (box.y + box.height / 2 - 5)) <= 1);
    mock.sendCursor(Buffer.alloc(0), [0.25, 0.5], [3, 5], true);
    await until(async () => (await cursorBox(page)).hidden, 'the end of the pointer in the window');
    assert.deepEqual(faults, []);
    await close();
    await mock.close();
});
