// The division of the work: cuts over the wall, shares, measured and predicted times, and the equalizers' parameters.

import { useState } from 'preact/hooks';
import { ms, percent, count } from '../parts/format.ts';
import { Picture } from '../parts/picture.tsx';
import { useCell } from '../session/cell.ts';
import { equalizersOf, type Session } from '../session/session.ts';
import { percentOf, partOf } from '../session/wall_geometry.ts';
import type { Equalizer, Rect, Wall } from '../wire/types.ts';
import type { ViewProps } from './view.ts';

interface Part {
    node: number;
    part: number;
    replayMs: number;
    // Time that the equalizer predicts. Without a prediction: the mean, which its cuts move towards. NaN: no measurement.
    predictedMs: number;
    isPredicted: boolean;
    // Area as fractions of the picture; heads without it report parts only.
    area: Rect | null;
}

function areaOf(entry: Record<string, unknown>): Rect | null {
    const area = entry.area ?? entry.rect ?? entry.viewport;
    return Array.isArray(area) && area.length === 4 && area.every(value => typeof value === 'number') ? (area as Rect) : null;
}

export function partsOf(equalizer: Equalizer, session: Session): Part[] {
    const rates = session.history.rates;
    const latest = rates[rates.length - 1];
    const times = equalizer.nodes.map(({ node }) => latest?.nodes.get(node)?.replayMs ?? NaN);
    const known = times.filter(Number.isFinite);
    const mean = known.length ? known.reduce((sum, time) => sum + time, 0) / known.length : NaN;
    return equalizer.nodes.map((entry, i) => {
        const { predictedMs: own, measuredMs } = entry as unknown as Record<string, unknown>;
        return {
            node: entry.node, part: entry.part, replayMs: typeof measuredMs === 'number' ? measuredMs : times[i]!,
            predictedMs: typeof own === 'number' ? own : mean,
            isPredicted: typeof own === 'number',
            area: areaOf(entry as unknown as Record<string, unknown>),
        };
    });
}

function Cuts({ session, wall, parts }: { session: Session; wall: Wall | null; parts: Part[] }) {
    const areas = parts.filter(part => part.area);
    const canvas = wall?.canvases[0];
    const fixed = !areas.length && canvas ? canvas.segments.map(segment => ({ node: segment.node, area: partOf(segment, canvas) })) : [];
    const [width, height] = wall?.program.size ?? [16, 9];
    return (
        <div class="wall-frame cuts" style={{ aspectRatio: `${width} / ${height}`, '--ratio': String(width / height) }}>
            <Picture hub={session.pictures} of="wall" isPreviewOnly label="Picture of the wall, with the areas of the nodes" />
            {[...areas, ...fixed].map(({ node, area }) => (
                <span key={node} class={`cut series-${node % 8}`} style={percentOf(area!, [0, 0, 1, 1])}><b>node {node}</b></span>
            ))}
        </div>
    );
}

function Parameter({ session, equalizer, name }: { session: Session; equalizer: Equalizer; name: string }) {
    const [draft, setDraft] = useState<string | null>(null);
    const value = equalizer.parameters[name] ?? '';
    const mayChange = session.may('operate');
    return (
        <form class="row" onSubmit={async event => {
            event.preventDefault();
            // The draft of the last render is outdated if Enter follows the last key at once.
            const wanted = String(new FormData(event.currentTarget).get('value'));
            const done = await session.perform('equalizer-set', { name: equalizer.name, parameter: name, value: wanted }, `${name} is ${wanted}.`);
            if (done) setDraft(null);
        }}>
            <label>
                <span>{name.replaceAll('_', ' ')}</span>
                <input name="value" value={draft ?? value} disabled={!mayChange} spellcheck={false} autocomplete="off"
                    onInput={event => setDraft(event.currentTarget.value)} />
            </label>
            {/* Not disabled without a draft: Enter has no effect while the button of the form is disabled. */}
            {mayChange && <button>Set</button>}
        </form>
    );
}

function EqualizerCard({ session, equalizer }: { session: Session; equalizer: Equalizer }) {
    const parts = partsOf(equalizer, session);
    const goal = parts.some(part => part.isPredicted) ? 'Predicted' : 'Equal times';
    const longest = Math.max(0.001, ...parts.map(part => Math.max(part.replayMs || 0, part.predictedMs || 0)));
    return (
        <section class="card">
            <div class="line">
                <h2>{equalizer.name}</h2>
                <span class="faint">{equalizer.kind.replaceAll('_', ' ')} divides {equalizer.divides}</span>
                {session.may('operate') && (
                    <button aria-pressed={equalizer.frozen}
                        onClick={() => session.perform('equalizer-freeze', { name: equalizer.name, frozen: !equalizer.frozen },
                            equalizer.frozen ? `${equalizer.name} moves parts again.` : `${equalizer.name} keeps its parts.`)}>
                        {equalizer.frozen ? 'Release' : 'Freeze'}
                    </button>
                )}
            </div>
            <p>{equalizer.frozen ? <b>Frozen. </b> : ''}{equalizer.decision.charAt(0).toUpperCase() + equalizer.decision.slice(1)}. Nodes are busy {percent(equalizer.efficiency)} of the longest time.
                {' '}Moved after {count(equalizer.moves)} of {count(equalizer.frames)} frames.</p>
            <div class="shares" role="img" aria-label={parts.map(part => `node ${part.node} ${percent(part.part)}`).join(', ')}>
                {parts.map(part => (
                    <span key={part.node} class={`series-${part.node % 8}`} style={{ flexGrow: String(Math.max(0.001, part.part)) }}>
                        <b>{part.node}</b> {percent(part.part)}
                    </span>
                ))}
            </div>
            <div class="balance-table" tabIndex={0} role="region" aria-label={`Times of ${equalizer.name}`}>
            <table class="balance">
                <caption class="hidden">Times of {equalizer.name}</caption>
                <thead><tr><th scope="col">Node</th><th scope="col" class="number">Part</th><th scope="col">{`Measured (bar), ${goal.toLowerCase()} (line)`}</th>
                    <th scope="col" class="number">Measured</th><th scope="col" class="number">{goal}</th></tr></thead>
                <tbody>
                    {parts.map(part => (
                        <tr key={part.node}>
                            <th scope="row">node {part.node}</th>
                            <td class="number">{percent(part.part)}</td>
                            <td><span class="measure" aria-hidden="true">
                                <span class={`series-${part.node % 8}`} style={{ width: `${((part.replayMs || 0) / longest) * 100}%` }} />
                                <i style={{ left: `${((part.predictedMs || 0) / longest) * 100}%` }} />
                            </span></td>
                            <td class="number">{ms(part.replayMs)}</td>
                            <td class="number">{ms(part.predictedMs)}</td>
                        </tr>
                    ))}
                </tbody>
            </table>
            </div>
            <h3>Parameters</h3>
            <div class="parameters">
                {Object.keys(equalizer.parameters).map(name => (
                    <Parameter key={name} session={session} equalizer={equalizer} name={name} />
                ))}
            </div>
        </section>
    );
}

export function BalanceView({ session }: ViewProps) {
    const status = useCell(session.status);
    const wall = useCell(session.wall);
    const equalizers = equalizersOf(status);
    const first = equalizers[0];
    return (
        <>
            <Cuts session={session} wall={wall} parts={first ? partsOf(first, session) : []} />
            {!equalizers.length && <p class="empty">The plan has no equalizer, so parts stay as they are.
                {session.may('operate') && ' The configuration can select one.'}</p>}
            {equalizers.map(equalizer => <EqualizerCard key={equalizer.name} session={session} equalizer={equalizer} />)}
        </>
    );
}
