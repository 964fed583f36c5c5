// The last frames over all machines on one clock: frame times, a Gantt chart, the slowest stage, means, and the export.

import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { Chart, colour } from '../parts/chart.tsx';
import { ms, short } from '../parts/format.ts';
import { changed, drawGantt, ganttHeight, labelWidth, rowsOf, spanAt, type GanttColours, type Range, type Span } from '../parts/gantt.ts';
import { Table } from '../parts/table.tsx';
import { useCell } from '../session/cell.ts';
import { isWait, placeOf, summarize, type FrameSummary } from '../session/frame_store.ts';
import type { FrameRecord } from '../wire/types.ts';
import { saveDocument } from './save_document.ts';
import type { ViewProps } from './view.ts';

const kActivities = ['capture', 'encode', 'send', 'receive', 'decode', 'replay', 'readback', 'compose', 'compress', 'transfer',
    'assemble', 'present', 'output'];
const kFollowed = 10;

function ganttColours(): GanttColours {
    return {
        text: colour('--text'), faint: colour('--faint'), line: colour('--line'), row: colour('--row'), wait: colour('--wait'),
        kinds: Object.fromEntries(kActivities.map(kind => [kind, colour(`--stage-${kind}`)])),
    };
}

function lastRange(frames: FrameRecord[], many: number): Range {
    const done = frames.filter(frame => frame.doneNs);
    const last = done[done.length - 1];
    const first = done[Math.max(0, done.length - 1 - many)];
    if (!last || !first || last === first) return { fromNs: (last?.doneNs ?? 0) - 1e8, toNs: last?.doneNs ?? 1 };
    return { fromNs: first.doneNs, toNs: last.doneNs };
}

function Verdict({ summary }: { summary: FrameSummary }) {
    const { slowest } = summary;
    if (!slowest || !(summary.frames > 1)) return <p class="verdict">Statistics begin with the next frames.</p>;
    return (
        <p class="verdict" role="status">
            <b>{ms(summary.frameMs)}</b> per frame, {short(1000 / summary.frameMs)} frames/s. Slowest stage:{' '}
            <b>{slowest.kind} on {placeOf(slowest.process, slowest.number)}</b>, {ms(slowest.ms)} per frame.
        </p>
    );
}

function Gantt({ frames, kinds, range, onRange }: {
    frames: FrameRecord[]; kinds: string[]; range: Range; onRange(change: (range: Range) => Range): void;
}) {
    const canvas = useRef<HTMLCanvasElement>(null);
    const [under, setUnder] = useState<Span | null>(null);
    const [scheme, setScheme] = useState(0);
    const drag = useRef<number | null>(null);
    const rows = useMemo(() => rowsOf(frames, kinds), [frames, kinds]);
    useEffect(() => {
        const element = canvas.current!;
        const draw = () => drawGantt(element, rows, frames, range, ganttColours());
        draw();
        const resize = new ResizeObserver(draw);
        resize.observe(element);
        return () => resize.disconnect();
    }, [rows, frames, range, scheme]);
    useEffect(() => {
        const query = matchMedia('(prefers-color-scheme: dark)');
        const change = () => setScheme(value => value + 1);
        query.addEventListener('change', change);
        return () => query.removeEventListener('change', change);
    }, []);
    const share = (element: HTMLElement, clientX: number) => {
        const box = element.getBoundingClientRect();
        const left = labelWidth(box.width);
        return Math.min(1, Math.max(0, (clientX - box.left - left) / (box.width - left)));
    };
    // A listener of its own, because listeners of the framework are passive.
    useEffect(() => {
        const element = canvas.current!;
        const wheel = (event: WheelEvent) => {
            if (!event.ctrlKey && !event.shiftKey) return;
            event.preventDefault();
            const around = share(element, event.clientX);
            onRange(old => changed(old, 1.0015 ** (event.deltaY || event.deltaX), around, 0));
        };
        element.addEventListener('wheel', wheel, { passive: false });
        return () => element.removeEventListener('wheel', wheel);
    }, [onRange]);
    const key = (event: KeyboardEvent) => {
        const moves: Record<string, [number, number]> = {
            ArrowLeft: [1, -0.2], ArrowRight: [1, 0.2], '+': [0.6, 0], '=': [0.6, 0], '-': [1.6, 0],
        };
        const move = moves[event.key];
        if (!move) return;
        event.preventDefault();
        onRange(old => changed(old, move[0], 0.5, move[1]));
    };
    return (
        <>
            <canvas ref={canvas} class="gantt" tabIndex={0} role="img" style={{ height: `${ganttHeight(rows)}px` }}
                aria-label={`Spans of ${rows.names.length} threads. Arrows move, plus and minus zoom. The table below has the means.`}
                onKeyDown={key}
                onPointerDown={event => { drag.current = event.clientX; event.currentTarget.setPointerCapture(event.pointerId); }}
                onPointerUp={() => { drag.current = null; }}
                onPointerMove={event => {
                    const box = event.currentTarget.getBoundingClientRect();
                    if (drag.current !== null) {
                        const move = (drag.current - event.clientX) / (box.width - labelWidth(box.width));
                        drag.current = event.clientX;
                        onRange(old => changed(old, 1, 0, move));
                    }
                    setUnder(spanAt(rows, range, box.width, event.clientX - box.left, event.clientY - box.top));
                }}
                onPointerLeave={() => setUnder(null)} />
            <p class="under">{under ? `${under.row}, frame ${under.frame}: ${under.kind}, ${ms((under.endNs - under.beginNs) / 1e6)}`
                : 'Drag moves, Ctrl and the wheel zoom. Bars are work, thin lines are waits, dashes end frames.'}</p>
        </>
    );
}

export function TimelineView({ session }: ViewProps) {
    const version = useCell(session.frames.version);
    const [held, setHeld] = useState<{ frames: FrameRecord[]; kinds: string[] } | null>(null);
    const [range, setRange] = useState<Range | null>(null);
    const [many, setMany] = useState(kFollowed);
    useEffect(() => session.useTimeline(), [session]);
    const { frames, kinds } = held ?? session.frames;
    const summary = useMemo(() => summarize(frames, kinds), [frames, kinds]);
    const shown = range ?? lastRange(frames, many);
    const followed = useRef(shown);
    followed.current = shown;
    const hold = () => setHeld(old => old ?? { frames: session.frames.frames, kinds: session.frames.kinds });
    // A change of the range keeps the frames, because moving data cannot be read.
    const change = useMemo(() => (next: (range: Range) => Range) => {
        hold();
        setRange(old => next(old ?? followed.current));
    }, []);
    const follow = (frames: number) => {
        setHeld(null);
        setRange(null);
        setMany(frames);
    };
    const done = useMemo(() => frames.filter(frame => frame.doneNs), [frames]);
    const times = useMemo(() => ({
        x: done.slice(1).map(frame => frame.number),
        series: [{ label: 'frame', values: done.slice(1).map((frame, i) => (frame.doneNs - done[i]!.doneNs) / 1e6) }],
    }), [done]);
    const select = (from: number, to: number) => {
        const first = done.find(frame => frame.number >= from);
        const last = [...done].reverse().find(frame => frame.number <= to);
        if (first && last && last.doneNs > first.doneNs) change(() => ({ fromNs: first.doneNs, toNs: last.doneNs }));
    };
    const stages = summary.stages.filter(stage => stage.ms >= 0.005);
    return (
        <div data-version={version}>
            <div class="line">
                <Verdict summary={summary} />
                <span class="buttons">
                    {[10, 60, 600].map(frames => (
                        <button key={frames} aria-pressed={!held && many === frames} onClick={() => follow(frames)}>{frames} frames</button>
                    ))}
                    <button aria-label="Zoom in" onClick={() => change(old => changed(old, 0.6, 0.5, 0))}>+</button>
                    <button aria-label="Zoom out" onClick={() => change(old => changed(old, 1.6, 0.5, 0))}>−</button>
                    <button aria-pressed={held !== null} onClick={() => (held ? follow(many) : hold())}>{held ? 'Continue' : 'Hold'}</button>
                    <button onClick={() => saveDocument(session, `api/v1/trace.json?frames=${Math.min(600, Math.max(1, frames.length))}`, 'mural-trace.json')}>
                        Save trace
                    </button>
                </span>
            </div>
            {done.length > 2 ? <>
                <Chart title={`Time of each frame, mean ${ms(summary.frameMs)}`} x={times.x} series={times.series} height={120} format={ms}
                    formatX={frame => `#${frame}`} onRange={select} />
                <Gantt frames={frames} kinds={kinds} range={shown} onRange={change} />
                <Table caption="Mean times per frame" rows={stages} empty=""
                    keyOf={stage => `${stage.process} ${stage.number} ${stage.kind}`}
                    columns={[
                        { name: 'Place', key: stage => placeOf(stage.process, stage.number), show: stage => placeOf(stage.process, stage.number) },
                        { name: 'State', key: stage => stage.kind, show: stage => <>{stage.kind}{stage === summary.slowest && <b> slowest</b>}</> },
                        { name: 'Kind', key: stage => Number(isWait(stage.kind)), show: stage => (isWait(stage.kind) ? 'wait' : 'work') },
                        { name: 'Per frame', isNumber: true, key: stage => stage.ms, show: stage => ms(stage.ms) },
                    ]} />
            </> : <p class="empty">The session records statistics while this view is open. Frames appear within a second if the program draws.</p>}
        </div>
    );
}
