// Changes of the layout and of the plan: check, try for some seconds, then keep or revert.

import { useEffect, useState } from 'preact/hooks';
import { useCell } from '../session/cell.ts';
import type { Session } from '../session/session.ts';
import type { PlanChange } from '../wire/types.ts';
import { short } from '../parts/format.ts';

type Value = string | number | boolean;
type Options = Record<string, unknown>;

const kTrySeconds = 30;
// Fields that most changes concern. The others follow in a part that opens.
const kOften = ['columns', 'rows', 'balance', 'ranges', 'period', 'samples', 'tileWidth', 'tileHeight', 'chunks', 'composition'];

function label(name: string): string {
    return name.replace(/([A-Z])/g, letter => ' ' + letter.toLowerCase());
}

export function changeText(change: PlanChange): string {
    const nodes = (list: number[] | undefined) => (list?.length ? list.join(', ') : 'none');
    return `Nodes that start: ${nodes(change.joined)}; end: ${nodes(change.left)}; continue: ${nodes(change.kept)}.`
        + (change.seconds === undefined ? '' : ` It took ${short(change.seconds)} s.`);
}

function ChangeButtons({ session, op, args, isReady, onDone }: {
    session: Session; op: string; args: Options; isReady: boolean; onDone(): void;
}) {
    const [result, setResult] = useState<PlanChange | null>(null);
    const [isBusy, setBusy] = useState(false);
    const key = JSON.stringify(args);
    useEffect(() => setResult(null), [key]);
    const perform = async (extra: Options, done: string) => {
        setBusy(true);
        const change = await session.perform<PlanChange>(op, { ...args, ...extra }, done);
        setBusy(false);
        if (change && 'joined' in change) setResult(change);
        if (change && !('dry-run' in extra)) onDone();
    };
    return (
        <>
            <div class="buttons">
                <button type="button" disabled={!isReady || isBusy} onClick={() => perform({ 'dry-run': true }, '')}>Check</button>
                <button type="button" class="primary" disabled={!isReady || isBusy}
                    onClick={() => perform({ 'revert-after': kTrySeconds }, `The change reverts after ${kTrySeconds} s unless you keep it.`)}>
                    Try for {kTrySeconds} s
                </button>
            </div>
            {result && (
                <div role="status">
                    <p>{changeText(result)}</p>
                    {result.warnings?.map(warning => <p key={warning} class="warning">{warning}</p>)}
                </div>
            )}
        </>
    );
}

export function LayoutChange({ session }: { session: Session }) {
    const wall = useCell(session.wall);
    const [canvas, setCanvas] = useState('');
    const [layout, setLayout] = useState('');
    const choices = (wall?.canvases ?? []).filter(entry => entry.layouts.length > 0);
    const selected = choices.find(entry => entry.name === canvas) ?? choices[0];
    if (!selected) return <p class="faint">This session has no canvases with layouts.</p>;
    const wanted = layout || selected.layout || 'off';
    return (
        <form onSubmit={event => event.preventDefault()}>
            <div class="parameters">
                <label class="row">canvas
                    <select value={selected.name} onChange={event => { setCanvas(event.currentTarget.value); setLayout(''); }}>
                        {choices.map(entry => <option key={entry.name}>{entry.name}</option>)}
                    </select>
                </label>
                <label class="row">layout
                    <select value={wanted} onChange={event => setLayout(event.currentTarget.value)}>
                        {[...new Set([...selected.layouts, 'off'])].map(name => <option key={name}>{name}</option>)}
                    </select>
                </label>
            </div>
            <ChangeButtons session={session} op="layout" args={{ canvas: selected.name, layout: wanted }}
                isReady={wanted !== selected.layout} onDone={() => { setLayout(''); void session.refreshWall(); }} />
        </form>
    );
}

function Field({ name, value, onChange }: { name: string; value: Value; onChange(value: Value): void }) {
    if (typeof value === 'boolean')
        return <label class="row">{label(name)}<input type="checkbox" checked={value} onChange={event => onChange(event.currentTarget.checked)} /></label>;
    if (typeof value === 'number')
        return (
            <label class="row">{label(name)}
                <input type="number" step="any" value={value} onInput={event => {
                    const number = event.currentTarget.valueAsNumber;
                    if (Number.isFinite(number)) onChange(number);
                }} />
            </label>
        );
    return (
        <label class="row">{label(name)}
            <input value={value} spellcheck={false} autocomplete="off" onInput={event => onChange(event.currentTarget.value)} />
        </label>
    );
}

export function PlanOptions({ session }: { session: Session }) {
    const [options, setOptions] = useState<Options | null>(null);
    const [draft, setDraft] = useState<Record<string, Value>>({});
    const status = useCell(session.status);
    const nodes = status?.nodes.map(node => node.node).join();
    useEffect(() => {
        session.request<{ options: Options }>('plan').then(result => setOptions(result.options)).catch(() => setOptions(null));
    }, [session, nodes, status?.revertsInSeconds === null]);
    if (!options) return <p class="faint">The session does not report its plan.</p>;
    const fields = Object.keys(options).filter(name => ['string', 'number', 'boolean'].includes(typeof options[name]));
    const changed = Object.fromEntries(Object.entries(draft).filter(([name, value]) => value !== options[name]));
    const field = (name: string) => (
        <Field key={name} name={name} value={draft[name] ?? (options[name] as Value)} onChange={value => setDraft({ ...draft, [name]: value })} />
    );
    return (
        <form onSubmit={event => event.preventDefault()}>
            <div class="parameters">{kOften.filter(name => fields.includes(name)).map(field)}</div>
            <details>
                <summary>All options</summary>
                <div class="parameters">{fields.filter(name => !kOften.includes(name)).map(field)}</div>
            </details>
            <ChangeButtons session={session} op="plan" args={{ options: changed }} isReady={Object.keys(changed).length > 0}
                onDone={() => { setDraft({}); void session.refreshWall(); }} />
        </form>
    );
}

// The decision about a change on trial. All views show it, because it reverts by itself.
export function TrialBanner({ session }: { session: Session }) {
    const status = useCell(session.status);
    const connection = useCell(session.connection);
    const left = status?.revertsInSeconds;
    if (connection.phase !== 'open') return null;
    if (left === null || left === undefined) return null;
    return (
        <div class="banner warn" role="alert">
            <span>A change of the plan reverts in {Math.ceil(left)} s.</span>
            {session.may('operate') && <span class="buttons">
                <button class="primary" onClick={() => session.perform('keep', {}, 'The change is kept.')}>Keep</button>
                <button onClick={() => session.perform('undo', {}, 'The change is reverted.')}>Revert now</button>
            </span>}
        </div>
    );
}
