// Clicks into a picture of a remote program in headless Chromium, and measures the time until its middle changes.
//   node browser_latency.mjs ADDRESS CLICKS PAUSE_MS     a page of mural, or vnc_lite.html of noVNC
// Prints one line of JSON: times in ms, bytes that the page's WebSockets received per click, and the picture's size.
import { createRequire } from 'node:module';

const require = createRequire(new URL('../../page/package.json', import.meta.url));
const { chromium } = require('playwright-core');

const [address, clicks, pauseMs] = process.argv.slice(2);
const kPatienceMs = 30000, kChangeMs = 10000;
const isNoVnc = address.includes('vnc_lite');
const kCanvas = isNoVnc ? '#screen canvas' : '.surface .picture';

// Runs in the page. The event's time stamp is the begin, so that the time of Playwright's protocol is not measured.
function watchNextChange([selector, limitMs]) {
    const canvas = document.querySelector(selector);
    const pixels = canvas.getContext('2d');
    const middle = () => pixels.getImageData(canvas.width >> 1, canvas.height >> 1, 1, 1).data;
    const before = middle();
    window.change = new Promise(resolve => {
        setTimeout(() => resolve(null), 2 * limitMs); // no event
        addEventListener('pointerdown', event => {
            const look = () => {
                const now = middle();
                const isOther = Math.abs(now[0] - before[0]) + Math.abs(now[1] - before[1]) + Math.abs(now[2] - before[2]) > 200;
                const passedMs = performance.now() - event.timeStamp;
                if (isOther || passedMs > limitMs) resolve(isOther ? passedMs : null);
                else setTimeout(look, 1);
            };
            look();
        }, { capture: true, once: true });
    });
}

const browser = await chromium.launch({ executablePath: process.env.MURAL_CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', '--disable-gpu'] });
try {
    const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
    let bytes = 0;
    page.on('websocket', socket => socket.on('framereceived', ({ payload }) => (bytes += payload.length)));
    await page.goto(address);
    if (!isNoVnc) {
        await page.click('button:text("Take control")', { timeout: kPatienceMs });
        await page.waitForSelector('.surface.active');
        await page.click('button:text("1:1")');
    }
    // The middle of the picture is one of the program's colours, none of which is dark.
    await page.waitForFunction(selector => {
        const canvas = document.querySelector(selector);
        if (!canvas || canvas.width < 64) return false;
        const [red, green, blue] = canvas.getContext('2d').getImageData(canvas.width >> 1, canvas.height >> 1, 1, 1).data;
        return Math.max(red, green, blue) > 150;
    }, kCanvas, { timeout: kPatienceMs });
    const wait = ms => new Promise(resolve => setTimeout(resolve, ms));
    await wait(2000); // a still of the first picture
    const box = await page.$eval(kCanvas, canvas => canvas.getBoundingClientRect().toJSON());
    const size = await page.$eval(kCanvas, canvas => [canvas.width, canvas.height]);
    bytes = 0;
    const times = [];
    for (let i = 0; i < Number(clicks); ++i) {
        await page.mouse.move(box.x + 40 + (i % 10), box.y + 40);
        await page.evaluate(watchNextChange, [kCanvas, kChangeMs]);
        await page.mouse.down();
        times.push(await page.evaluate('window.change'));
        await page.mouse.up();
        // Different phases relative to the page's own timers.
        await wait(Number(pauseMs) + (i * 37) % 100);
    }
    console.log(JSON.stringify({ times, bytesPerClick: bytes / Number(clicks), size }));
} finally {
    await browser.close();
}
