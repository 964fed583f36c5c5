// Operations of the views: layout, plan, links, recording, equalizers, replacement, and the loss of a node.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open, show, startMock, until, waitForPicture } from './browser.mjs';

let browser;
let mock;
before(async () => {
    browser = await launch();
    mock = await startMock();
});
after(async () => {
    await browser.close();
    await mock.close();
});

async function onPage(view, run) {
    const { page, faults, close } = await open(browser, mock, { view });
    await page.waitForSelector(`nav a[aria-current][href="#${view.split('/')[0]}"]`);
    mock.requests.length = 0;
    await run(page);
    assert.deepEqual(faults, []);
    await close();
}

const sent = op => mock.requests.filter(request => request.op === op).map(request => request.args);

test('a layout is checked, tried, and kept', () => onPage('configuration', async page => {
    await page.selectOption('select >> nth=1', '2D');
    await page.click('button:text("Check") >> nth=0');
    await page.waitForSelector('text=node 0 and node 1 share one GPU');
    assert.deepEqual(sent('layout').at(-1), { canvas: 'wall', layout: '2D', 'dry-run': true });
    await page.click('button:text("Try for 30 s") >> nth=0');
    await page.waitForSelector('.banner.warn');
    assert.match(await page.innerText('.banner.warn'), /reverts in \d+ s/);
    assert.deepEqual(sent('layout').at(-1), { canvas: 'wall', layout: '2D', 'revert-after': 30 });
    await show(page, 'wall');
    await page.click('.banner button:text("Keep")');
    await until(() => sent('keep').length === 1, 'keep');
    await page.waitForSelector('.banner.warn', { state: 'detached' });
}));

test('only changed options of the plan are sent', () => onPage('configuration', async page => {
    await page.fill('label:has-text("columns") input', '4');
    await page.fill('label:has-text("balance") input', 'load');
    await page.click('button:text("Check") >> nth=1');
    await until(() => sent('plan').length > 0, 'plan');
    assert.deepEqual(sent('plan').at(-1), { options: { columns: 4, balance: 'load' }, 'dry-run': true });
    for (const [form, proof] of [['Tree', 'config'], ['Text', 'mural_bezel_mm']]) {
        await page.click(`[role=tab]:text("${form}")`);
        await page.waitForSelector(`[role=tabpanel] >> text=${proof} >> nth=0`);
    }
}));

test('a link appears once with its QR code, and is revoked', () => onPage('links', async page => {
    await page.selectOption('select >> nth=0', 'input');
    await page.fill('label:has-text("name") input', 'Größe');
    await page.click('button:text("Create link")');
    await page.waitForSelector('.qr path');
    assert.match(await page.inputValue('.new-link input'), /^http:\/\/127\.0\.0\.1:\d+\/#t=[\w-]{43}$/);
    assert.deepEqual(sent('link-new'), [{ role: 'input', seconds: 28800, most: 20, name: 'Größe' }]);
    await page.click('.new-link button:text("Done")');
    await page.waitForSelector('.new-link', { state: 'detached' });
    assert.ok(!(await page.content()).includes('#t='));
    assert.equal(sent('link-new').length, 1);
    await page.click('button:text("Revoke")');
    await page.click('button:text("Close its pages")');
    await until(() => sent('link-revoke').length === 1, 'link-revoke');
    await page.waitForSelector('text=No links.');
}));

test('recordings begin and end, and pictures and traces are saved', () => onPage('record', async page => {
    await page.fill('form input', 'schöner.mural');
    await page.click('button:text("Record")');
    await page.waitForSelector('.top .state:text("recording")');
    await page.click('button:text("End the recording")');
    await until(() => sent('record-stop').length === 1, 'record-stop');
    assert.deepEqual(sent('record-start'), [{ file: 'schöner.mural' }]);
    const [picture] = await Promise.all([page.waitForEvent('download'), page.click('button:text("Save JPEG")')]);
    assert.match(picture.suggestedFilename(), /^mural-\d+\.jpg$/);
    await show(page, 'timeline');
    const [trace] = await Promise.all([page.waitForEvent('download'), page.click('button:text("Save trace")')]);
    assert.equal(trace.suggestedFilename(), 'mural-trace.json');
}));

test('an equalizer is frozen and set, and refuses words', () => onPage('balance', async page => {
    await page.click('button:text("Freeze")');
    await page.waitForSelector('button:text("Release")');
    assert.deepEqual(sent('equalizer-freeze'), [{ name: '0.load', frozen: true }]);
    await page.fill('label:has-text("damping") input', '0.25');
    await page.press('label:has-text("damping") input', 'Enter');
    await until(() => sent('equalizer-set').length === 1, 'equalizer-set');
    assert.deepEqual(sent('equalizer-set'), [{ name: '0.load', parameter: 'damping', value: '0.25' }]);
    await page.fill('label:has-text("damping") input', 'much');
    await page.press('label:has-text("damping") input', 'Enter');
    await page.waitForSelector('.notices .error:has-text("is not a number")');
    await page.click('button:text("Release")');
}));

test('a node is stopped by force only after the session has refused, identified, and replaced', () => onPage('wall/1', async page => {
    await page.click('.drawer button:text("Stop")');
    await page.click('.drawer button:text("Stop it now")');
    await page.waitForSelector('.notices .error:has-text("no other node takes the area")');
    assert.deepEqual(sent('stop-node'), [{ node: 1 }]);
    await page.click('.drawer button:text("Identify")');
    await until(() => sent('overlay').length === 1, 'overlay');
    assert.deepEqual(sent('overlay'), [{ mode: 'names', node: 1 }]);
    await page.fill('.replace input', 'wall9');
    await page.click('.replace button:text("Check")');
    await page.waitForSelector('.replace [role=status]');
    assert.deepEqual(sent('move-nodes'), [{ from: 'wall1', to: 'wall9', 'dry-run': true }]);
    await page.click('.drawer button:text("Stop anyway")');
    await page.click('.drawer button:text("Its part stays as it is")');
    await until(() => sent('stop-node').length === 2, 'stop-node with force');
    await page.click('.drawer button:text-is("Start")');
    await until(() => sent('start-node').length === 1, 'start-node');
}));

test('after a loss of the node its segment changes within a second', async () => {
    const { page, close } = await open(browser, mock);
    await waitForPicture(page);
    const begin = performance.now();
    mock.scene.lose(0);
    await page.waitForSelector('.segment.bad:has-text("lost")');
    const passed = performance.now() - begin;
    console.log(`lost node is marked after ${Math.round(passed)} ms`);
    assert.ok(passed < 3000);
    mock.scene.revive(0);
    await close();
});
