// A page of the mock server in headless Chromium. Skips all tests of a file, with the reason, where Chromium is absent.
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';
import { Mock } from '../../../tools/page/mock/server.mjs';

const require = createRequire(new URL('../../../tools/page/package.json', import.meta.url));
const { chromium } = require('playwright-core');

const kCandidates = [process.env.MURAL_CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const executablePath = kCandidates.find(path => path && existsSync(path));
// CTest skips a test that exits with 77.
if (!executablePath) {
    console.log('skipped: chromium is missing; tools/install-deps test installs it');
    process.exit(77);
}

export const kFolder = process.env.MURAL_PAGE_FOLDER ?? fileURLToPath(new URL('../../../tools/page/dist', import.meta.url));
export const kWide = { width: 1280, height: 720 };
export const kPhone = { width: 390, height: 844 };
export const kAllViews = ['wall', 'use', 'timeline', 'balance', 'nodes', 'network', 'program', 'configuration', 'record', 'log', 'links'];

// The flags permit Chromium in containers, and heap measurements of full precision.
export function launch() {
    return chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-gpu', '--enable-precise-memory-info', '--js-flags=--expose-gc'] });
}

// Most tests need no 24 pictures per second, whose decoding and drawing is most of their work.
const kStepsPerSecond = 8;

export async function startMock({ isQuiet = false, video = false } = {}) {
    const mock = new Mock({ folder: kFolder, video, isQuiet: isQuiet || !video });
    if (!isQuiet && !video) mock.timer = setInterval(() => mock.step(1 / kStepsPerSecond), 1000 / kStepsPerSecond);
    mock.port = await mock.listen();
    mock.address = `http://127.0.0.1:${mock.port}/`;
    return mock;
}

// Pages that no test uses now, by the form of their screen. A new context costs Chromium two processes.
const idle = { wide: [], phone: [] };

async function newTab(browser, form) {
    const isPhone = form === 'phone';
    const context = await browser.newContext({ viewport: isPhone ? kPhone : kWide, hasTouch: isPhone, isMobile: isPhone });
    const tab = { context, page: await context.newPage(), faults: [], mock: null };
    const { page } = tab;
    page.on('console', message => {
        if (message.type() === 'error' || message.type() === 'warning') tab.faults.push(message.text());
    });
    page.on('pageerror', error => tab.faults.push(error.message));
    page.on('request', request => {
        const { host, protocol } = new URL(request.url());
        if (protocol === 'http:' && host === `127.0.0.1:${tab.mock.port}`) return;
        if (protocol !== 'blob:' && protocol !== 'about:') tab.faults.push(`request to ${request.url()}`);
    });
    return tab;
}

// Opens the page. `faults` collects console errors, exceptions and requests to other hosts. The next test gets the same
// tab after close(); `isFresh` and `before` make a new one, without anything that an earlier page has left.
export async function open(browser, mock, { viewport = kWide, colorScheme = 'light', token = 'operate-token', view = '', before, isFresh = false } = {}) {
    const form = viewport === kPhone ? 'phone' : 'wide';
    const isShared = !isFresh && !before;
    const tab = (isShared && idle[form].pop()) || await newTab(browser, form);
    const { page, context } = tab;
    const faults = (tab.faults = []);
    tab.mock = mock;
    await page.emulateMedia({ colorScheme });
    if (before) await page.addInitScript(before);
    await page.goto(`${mock.address}#t=${token}${view && `&${view}`}`);
    const close = async () => {
        if (!isShared) return context.close();
        await page.evaluate(() => [sessionStorage, localStorage].forEach(storage => storage.clear()));
        await page.goto('about:blank');
        await page.mouse.move(0, 0);
        idle[form].push(tab);
    };
    return { page, faults, close };
}

export async function show(page, view) {
    await page.evaluate(name => (location.hash = name), view);
    await page.waitForSelector(`nav a[aria-current][href="#${view.split('/')[0]}"]`);
}

// Waits until the canvas of a picture shows the session's colours.
export function waitForPicture(page, selector = '.picture', timeout = 10000) {
    return page.waitForFunction(wanted => {
        const canvas = document.querySelector(wanted);
        if (!canvas?.dataset.frame) return false;
        const { data } = canvas.getContext('2d').getImageData(canvas.width >> 2, canvas.height >> 2, 1, 1);
        return data[0] + data[1] + data[2] > 60;
    }, selector, { timeout });
}

export async function until(condition, what, timeoutMs = 8000) {
    const end = performance.now() + timeoutMs;
    while (!(await condition())) {
        assert.ok(performance.now() < end, `timeout: ${what}`);
        await new Promise(resolve => setTimeout(resolve, 40));
    }
}
