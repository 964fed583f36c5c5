// The frame of the page: header, navigation, the view of the fragment, drawer, notices and the state of the connection.

import { useEffect, useRef, useState } from 'preact/hooks';
import type { FunctionComponent } from 'preact';
import { short } from './parts/format.ts';
import { StateMark } from './parts/state_mark.tsx';
import { useCell, useClock } from './session/cell.ts';
import { headline } from './session/condition.ts';
import type { Session } from './session/session.ts';
import { BalanceView } from './views/balance_view.tsx';
import { ConfigurationView } from './views/configuration_view.tsx';
import { LinksView } from './views/links_view.tsx';
import { LogView } from './views/log_view.tsx';
import { NetworkView } from './views/network_view.tsx';
import { NodeDrawer } from './views/node_drawer.tsx';
import { NodesView } from './views/nodes_view.tsx';
import { TrialBanner } from './views/plan_changes.tsx';
import { ProgramView } from './views/program_view.tsx';
import { RecordView } from './views/record_view.tsx';
import { TimelineView } from './views/timeline_view.tsx';
import { UseView } from './views/use_view.tsx';
import type { ViewProps } from './views/view.ts';
import { WallView } from './views/wall_view.tsx';
import { storeToken, tokenOf } from './wire/token.ts';
import type { Role } from './wire/types.ts';

interface View {
    name: string;
    title: string;
    role: Role;
    show: FunctionComponent<ViewProps>;
}

export const kViews: View[] = [
    { name: 'wall', title: 'Wall', role: 'view', show: WallView },
    { name: 'use', title: 'Use', role: 'view', show: UseView },
    { name: 'timeline', title: 'Timeline', role: 'view', show: TimelineView },
    { name: 'balance', title: 'Balance', role: 'view', show: BalanceView },
    { name: 'nodes', title: 'Nodes', role: 'view', show: NodesView },
    { name: 'network', title: 'Network', role: 'view', show: NetworkView },
    { name: 'program', title: 'Program', role: 'view', show: ProgramView },
    { name: 'configuration', title: 'Configuration', role: 'operate', show: ConfigurationView },
    { name: 'record', title: 'Record', role: 'operate', show: RecordView },
    { name: 'log', title: 'Log', role: 'operate', show: LogView },
    { name: 'links', title: 'Links', role: 'operate', show: LinksView },
];

// The fragment is VIEW or VIEW/NODE, so a node's drawer has an address, too.
function place(): { view: string; node: number | null } {
    const [view = '', node] = location.hash.slice(1).split('/');
    return { view, node: node !== undefined && /^\d+$/.test(node) ? Number(node) : null };
}

function ConnectionBanner({ session }: { session: Session }) {
    const connection = useCell(session.connection);
    const status = useCell(session.status);
    useClock(500);
    if (connection.phase === 'open' || connection.phase === 'refused' || (connection.phase === 'connecting' && !status)) return null;
    const seconds = Math.max(0, Math.ceil((connection.retryAtMs - performance.now()) / 1000));
    return (
        <div class="banner bad" role="alert">
            <span>No connection to the session{connection.reason && `: ${connection.reason}`}. The page shows the last known state.
                {connection.phase === 'connecting' ? ' It tries again now.' : ` It tries again in ${seconds} s.`}</span>
            <button onClick={() => session.retry()}>Try now</button>
        </div>
    );
}

function Refused({ session }: { session: Session }) {
    const connection = useCell(session.connection);
    const [text, setText] = useState('');
    return (
        <main class="refused">
            <h1>Mural</h1>
            <p role="alert">The session does not accept this page: {connection.reason}.</p>
            <form class="row" onSubmit={event => {
                event.preventDefault();
                const token = tokenOf(text);
                storeToken(token);
                session.useToken(token);
            }}>
                <label><span>Address or token that <code>mural page</code> prints</span>
                    <input value={text} required autocomplete="off" spellcheck={false} onInput={event => setText(event.currentTarget.value)} /></label>
                <button class="primary">Open</button>
            </form>
        </main>
    );
}

function Header({ session }: { session: Session }) {
    const status = useCell(session.status);
    const welcome = useCell(session.welcome);
    const connection = useCell(session.connection);
    const rates = session.history.latest;
    const isOpen = connection.phase === 'open';
    const program = status?.programs[0]?.command.replace(/^\S*\//, '');
    return (
        <header class="top">
            <h1>Mural</h1>
            <span class="program" title={status?.programs.map(entry => entry.command).join('\n')}>{program ?? (status ? 'no program' : '')}</span>
            {status && (isOpen ? <StateMark {...headline(status, rates)} /> : <StateMark mark="bad" word="no connection" />)}
            <span class="fill" />
            {status && <span class="figures" title={status.session}>
                <span><b>{short(rates?.framesPerSecond)}</b> frames/s</span>
                <span class="frame-number">frame <b>{status.frames}</b></span>
            </span>}
            {status?.recording && <StateMark mark="bad" word="recording" />}
            {welcome && welcome.role !== 'operate' && <span class="role">{welcome.role === 'view' ? 'view only' : 'view and use'}</span>}
        </header>
    );
}

function Notices({ session }: { session: Session }) {
    const notices = useCell(session.notices);
    return (
        <div class="notices" role="status" aria-live="polite">
            {notices.map(notice => (
                <p key={notice.id} class={notice.kind}>
                    {notice.kind === 'error' && <b>Failed: </b>}{notice.text}
                    <button class="icon" aria-label="Dismiss" onClick={() => session.dismiss(notice.id)}>✕</button>
                </p>
            ))}
        </div>
    );
}

export function App({ session }: { session: Session }) {
    const connection = useCell(session.connection);
    const welcome = useCell(session.welcome);
    const status = useCell(session.status);
    const [at, setAt] = useState(place);
    const opener = useRef<Element | null>(null);
    useEffect(() => {
        const change = () => setAt(place());
        addEventListener('hashchange', change);
        return () => removeEventListener('hashchange', change);
    }, []);
    const views = kViews.filter(view => welcome && session.may(view.role));
    const view = kViews.find(entry => entry.name === at.view) ?? kViews[0]!;
    useEffect(() => {
        document.title = `${view.title} – Mural${status?.programs[0] ? ` – ${status.programs[0].command.replace(/^\S*\//, '').slice(0, 40)}` : ''}`;
    }, [view, status?.programs[0]?.command]);
    if (connection.phase === 'refused') return <Refused session={session} />;
    const openNode = (node: number) => {
        opener.current = document.activeElement;
        location.hash = `${view.name}/${node}`;
    };
    const closeNode = () => {
        location.hash = view.name;
        if (opener.current instanceof HTMLElement) opener.current.focus();
    };
    const Show = view.show;
    return (
        <div class={`app ${connection.phase === 'open' ? '' : 'stale'} ${at.node === null ? '' : 'has-drawer'}`}>
            <a class="skip" href={`#${view.name}`} onClick={event => {
                event.preventDefault();
                document.querySelector<HTMLElement>('main')?.focus();
            }}>Skip to the view</a>
            <Header session={session} />
            <nav aria-label="Views">
                {views.map(({ name, title }) => (
                    <a key={name} href={`#${name}`} aria-current={name === view.name ? 'page' : undefined}
                        ref={element => { if (name === view.name) element?.scrollIntoView?.({ block: 'nearest', inline: 'nearest' }); }}>{title}</a>
                ))}
            </nav>
            <main tabIndex={-1} aria-label={view.title}>
                <ConnectionBanner session={session} />
                <TrialBanner session={session} />
                {welcome ? <Show session={session} openNode={openNode} /> : <p class="empty" role="status">Connecting to the session.</p>}
            </main>
            {at.node !== null && welcome && <NodeDrawer session={session} node={at.node} onClose={closeNode} />}
            <Notices session={session} />
        </div>
    );
}
