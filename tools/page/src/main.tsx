// Start of the page.

import { options, render } from 'preact';
import 'uplot/dist/uPlot.min.css';
import './style/base.css';
import './style/views.css';
import { App } from './app.tsx';
import { Session } from './session/session.ts';
import { takeToken } from './wire/token.ts';

// The name by which other viewers recognize this browser.
function browserName(): string {
    const agent = navigator.userAgent;
    const browser = /Firefox/.test(agent) ? 'Firefox' : /Edg\//.test(agent) ? 'Edge' : /Chrome/.test(agent) ? 'Chrome' : /Safari/.test(agent) ? 'Safari' : 'Browser';
    const system = /Android/.test(agent) ? 'Android' : /iPhone|iPad/.test(agent) ? 'iOS' : /Windows/.test(agent) ? 'Windows' : /Mac/.test(agent) ? 'macOS' : 'Linux';
    return `${browser} on ${system}`;
}

// Messages that arrive within one frame of the browser cause one rendering, and none in a hidden tab.
options.debounceRendering = callback => requestAnimationFrame(() => callback());
const session = new Session(takeToken(), browserName());
// A link that is opened in this tab carries another token, and changes only the fragment.
addEventListener('hashchange', () => {
    if (!location.hash.startsWith('#t=')) return;
    session.useToken(takeToken());
    dispatchEvent(new HashChangeEvent('hashchange'));
});
render(<App session={session} />, document.getElementById('page')!);
void session.start();
