// Every view, on two sizes and in both colour schemes: it renders, has names for screen readers, and makes no fault.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kAllViews, kPhone, kWide, launch, open, show, startMock, until, waitForPicture } from './browser.mjs';

let browser;
let mock;
before(async () => {
    browser = await launch();
    mock = await startMock();
    mock.scene.isSlow = true;
    mock.scene.lose(3);
});
after(async () => {
    await browser.close();
    await mock.close();
});

// Text that shows that a view has its data.
const kProofs = {
    wall: 'lower.right', use: 'Take control', timeline: 'Slowest stage: replay on node 2', balance: 'Equal times', nodes: 'wänd-2', network: 'Multicast',
    program: 'glReadPixels', configuration: 'wall-2x2.eqc', record: 'no recording', log: 'was lost', links: 'New link',
};

// Returns controls without an accessible name, and texts below the contrast of 4.5 on plain grounds.
function inspect() {
    const nameOf = element => element.getAttribute('aria-label') || element.textContent.trim() || element.labels?.[0]?.textContent.trim() || element.title;
    const nameless = [...document.querySelectorAll('button, a[href], input, select, [role=img], [tabindex="0"]')]
        .filter(element => !element.closest('[aria-hidden=true]') && !nameOf(element)).map(element => element.outerHTML.slice(0, 120));
    const parse = text => (text.match(/[\d.]+/g) ?? []).map(Number);
    const light = ([r, g, b]) => [r, g, b].map(value => value / 255).map(value => (value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4))
        .reduce((sum, value, i) => sum + value * [0.2126, 0.7152, 0.0722][i], 0);
    const groundOf = element => {
        for (let at = element; at; at = at.parentElement) {
            const ground = parse(getComputedStyle(at).backgroundColor);
            if (ground.length === 3 || ground[3] === 1) return ground;
            if (ground[3] > 0) return null;
        }
        return [255, 255, 255];
    };
    const faint = [];
    for (const element of document.querySelectorAll('main *, nav *, header *, .drawer *')) {
        if (![...element.childNodes].some(node => node.nodeType === 3 && node.textContent.trim())) continue;
        if (element.closest('svg, :disabled, .segment, .drawing, .hidden') || !element.getClientRects().length) continue;
        const ground = groundOf(element);
        if (!ground) continue;
        const [a, b] = [light(parse(getComputedStyle(element).color)), light(ground)].sort((p, q) => q - p);
        if ((a + 0.05) / (b + 0.05) < 4.5) faint.push(`${element.textContent.trim().slice(0, 40)}: ${((a + 0.05) / (b + 0.05)).toFixed(2)}`);
    }
    return { nameless, faint, overflow: document.documentElement.scrollWidth - innerWidth };
}

for (const [sizeName, viewport, schemes] of [['1280x720', kWide, ['light', 'dark']], ['390x844', kPhone, ['dark', 'light']]])
    test(`all views at ${sizeName}, light and dark`, async () => {
        const { page, faults, close } = await open(browser, mock, { viewport, colorScheme: schemes[0] });
        await waitForPicture(page);
        for (const view of [...kAllViews, 'wall/2']) {
            await show(page, view);
            const proof = view === 'wall/2' ? 'per frame' : kProofs[view];
            await page.waitForFunction(text => document.querySelector('#page').innerText.includes(text)
                || document.querySelector('.drawing')?.textContent.includes(text), proof, { timeout: 10000 })
                .catch(() => assert.fail(`${view} does not show "${proof}"`));
            // Each view opens in one scheme, and changes to the other one while it is open.
            for (const colorScheme of schemes) {
                await page.emulateMedia({ colorScheme });
                const { nameless, faint, overflow } = await page.evaluate(inspect);
                assert.deepEqual(nameless, [], `${view}, ${colorScheme}`);
                assert.deepEqual(faint, [], `${view}, ${colorScheme}`);
                assert.ok(overflow <= 0, `${view}, ${colorScheme} is ${overflow} pixels too wide`);
            }
            schemes.reverse();
            assert.ok((await page.title()).startsWith(view === 'wall/2' ? 'Wall' : view[0].toUpperCase() + view.slice(1)));
        }
        assert.deepEqual(faults, []);
        await close();
    });

test('states are words and shapes, not only colours', async () => {
    const { page, close } = await open(browser, mock);
    await page.waitForSelector('.segment.bad');
    await page.waitForSelector('.segment.warn');
    const lines = await page.$$eval('.segment', segments => segments.map(segment => ({
        text: segment.innerText, shape: segment.querySelector('.shape').innerHTML, label: segment.getAttribute('aria-label'),
    })));
    const words = lines.map(line => /alive|slow|lost/.exec(line.text)?.[0]);
    assert.deepEqual(words, ['alive', 'alive', 'slow', 'lost']);
    assert.equal(new Set(lines.map(line => line.shape)).size, 3);
    lines.forEach((line, i) => assert.ok(line.label.includes(words[i]) && line.label.includes(`node ${i}`), line.label));
    await close();
});

test('segments have the places of their millimetres', async () => {
    const { page, close } = await open(browser, mock);
    await page.waitForSelector('.segment');
    const places = await page.$$eval('.segment', segments => segments.map(segment => {
        const frame = segment.parentElement.getBoundingClientRect();
        const box = segment.getBoundingClientRect();
        return [box.x - frame.x, box.y - frame.y, box.width, box.height].map(value => (value / frame.width) * 1240);
    }));
    mock.scene.wall().canvases[0].segments.forEach(({ rectMm }, i) =>
        rectMm.forEach((value, k) => assert.ok(Math.abs(value - places[i][k]) < 2, `${i}: ${places[i]} instead of ${rectMm}`)));
    await close();
});

test('the keyboard alone reaches views, segments and the drawer', async () => {
    const { page, close } = await open(browser, mock);
    await page.waitForSelector('.segment');
    const focused = () => page.evaluate(() => document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent);
    const seen = [];
    for (let i = 0; i < 40 && !(seen[seen.length - 1] ?? '').startsWith('lower.left'); ++i) {
        await page.keyboard.press('Tab');
        seen.push(await focused());
        const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
        assert.notEqual(outline, 'none', `no visible focus on ${seen[seen.length - 1]}`);
    }
    assert.equal(seen[0], 'Skip to the view');
    for (const view of ['Wall', 'Timeline', 'Links']) assert.ok(seen.includes(view), `${view} is not reachable: ${seen}`);
    await page.keyboard.press('Enter');
    await page.waitForSelector('.drawer');
    assert.equal(await focused(), 'Close');
    await page.keyboard.press('Escape');
    await page.waitForSelector('.drawer', { state: 'detached' });
    assert.ok((await focused()).startsWith('lower.left'), 'the focus returns to the segment');
    await close();
});

test('a new user finds the slow node, its reason, and its restart', async () => {
    const { page, close } = await open(browser, mock);
    await page.click('.segment.warn');
    await page.waitForSelector('.drawer .state.warn');
    const text = await page.innerText('.drawer');
    assert.match(text, /slow/);
    assert.match(text, /Replay takes [\d.]+ ms per frame; the median of the other nodes is/);
    assert.match(text, /Replay\s+\d/);
    mock.requests.length = 0;
    await page.click('.drawer button:text("Restart")');
    assert.equal(mock.requests.filter(({ op }) => op === 'restart-node').length, 0, 'one click does not restart');
    await page.click('.drawer button:text("Restart it now")');
    await until(() => mock.requests.some(({ op, args }) => op === 'restart-node' && args.node === 2), 'restart-node');
    await page.waitForSelector('.drawer .state:text("rejoining")');
    await until(async () => /slow|alive/.test(await page.innerText('.drawer .state')), 'the node is back');
    await close();
});
