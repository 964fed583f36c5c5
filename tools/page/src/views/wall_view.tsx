// The wall: every segment at its place in millimetres with its live picture and its state, and a table of the same.

import { Picture } from '../parts/picture.tsx';
import { StateMark, Shape, type Condition } from '../parts/state_mark.tsx';
import { Table } from '../parts/table.tsx';
import { count, duration, kNone, ms } from '../parts/format.ts';
import { useCell, useClock } from '../session/cell.ts';
import { conditionOf, outputCondition } from '../session/condition.ts';
import { frameOf, partOf, percentOf, sizeText } from '../session/wall_geometry.ts';
import type { Canvas, NodeStatus, Output, Segment } from '../wire/types.ts';
import type { ViewProps } from './view.ts';

interface Shown {
    canvas: Canvas;
    segment: Segment;
    node: NodeStatus | undefined;
    output: Output | undefined;
    condition: Condition;
    // Frame that the output shows, or that its node has finished, if the output has no proof of life; NaN: unknown.
    frame: number;
    // Frames behind the newest one; NaN: unknown.
    behind: number;
    ageSeconds: number;
}

// The output of a segment has its name; otherwise it is the only output of its node.
function outputOf(segment: Segment, canvas: Canvas, outputs: Output[]): Output | undefined {
    return outputs.find(output => output.output === segment.name && (output.canvas ?? canvas.name) === canvas.name)
        ?? outputs.find(output => output.node === segment.node);
}

function useShown({ session }: ViewProps): Shown[] {
    const wall = useCell(session.wall);
    const status = useCell(session.status);
    const outputs = useCell(session.outputs);
    const connection = useCell(session.connection);
    useClock(1000);
    // Ages grow while no message arrives. Without a connection they say nothing about the wall.
    const waited = connection.phase === 'open' ? Math.max(0, (performance.now() - session.outputsAtMs) / 1000 - 1.5) : 0;
    const newest = Math.max(...(outputs.length ? outputs.map(output => output.frame) : (status?.nodes ?? []).map(node => node.frames)));
    return (wall?.canvases ?? []).flatMap(canvas => canvas.segments.map(segment => {
        const node = status?.nodes.find(entry => entry.node === segment.node);
        const output = outputOf(segment, canvas, outputs);
        const ofNode = node ? conditionOf(node, session.history.latest) : { mark: 'idle' as const, word: 'no node' };
        const ofOutput = outputCondition(output, waited);
        const isNodeFirst = ofNode.mark === 'bad' || ofNode.mark === 'idle' || ofOutput?.mark !== 'bad';
        const frame = outputs.length ? output?.frame ?? NaN : node?.frames ?? NaN;
        const condition = isNodeFirst ? ofNode : ofOutput!;
        return {
            canvas, segment, node, output,
            // Without a connection the page knows only the past.
            condition: connection.phase === 'open' ? condition : { mark: 'idle' as const, word: `was ${condition.word}` },
            frame, behind: newest - frame,
            ageSeconds: output ? output.ageSeconds + waited : NaN,
        };
    }));
}

function behindText(behind: number): string {
    return Number.isFinite(behind) ? (behind === 0 ? 'newest' : `−${count(behind)}`) : kNone;
}

function skewText({ behind, output }: Shown): string {
    return behindText(behind) + (output?.skewMs != null ? `, ${ms(output.skewMs)}` : '');
}

function SegmentTile({ shown, frame, props }: { shown: Shown; frame: ReturnType<typeof frameOf>; props: ViewProps }) {
    const { canvas, segment, output, condition, behind, ageSeconds } = shown;
    const label = `${segment.name}, ${segment.node < 0 ? '' : `node ${segment.node}, `}${condition.word}`
        + (output ? `, frame ${output.frame}, picture confirmed ${duration(ageSeconds)} ago` : '');
    return (
        <button class={`segment ${condition.mark}`} style={percentOf(segment.rectMm, frame)} aria-label={label}
            disabled={segment.node < 0} onClick={() => props.openNode(segment.node)}>
            <Picture hub={props.session.pictures} of="wall" part={partOf(segment, canvas)} isPreviewOnly label="" />
            <span class="segment-line">
                <Shape mark={condition.mark} />
                <b>{segment.name}</b>
                <span class="segment-word">{condition.word}</span>
                <span class="segment-facts">
                    {Number.isFinite(shown.frame) ? `#${shown.frame}` : ''}
                    {behind > 0 ? ` (${behindText(behind)})` : ''}
                    {output ? ` · ${duration(ageSeconds)}` : ''}
                </span>
            </span>
        </button>
    );
}

export function WallView(props: ViewProps) {
    const { session } = props;
    const shown = useShown(props);
    const wall = useCell(session.wall);
    const status = useCell(session.status);
    const canvases = (wall?.canvases ?? []).filter(canvas => canvas.segments.length > 0);
    return (
        <>
            {canvases.map(canvas => {
                const frame = frameOf(canvas);
                return (
                    <section key={canvas.name} class="wall-canvas" aria-label={`Canvas ${canvas.name}`}>
                        <div class="line">
                            <h2>{canvas.name}</h2>
                            <span class="faint">{sizeText(canvas)}{canvas.layout ? `, layout ${canvas.layout}` : ''}</span>
                        </div>
                        <div class="wall-frame" style={{ aspectRatio: `${frame[2]} / ${frame[3]}`, '--ratio': String(frame[2] / frame[3]) }}>
                            {shown.filter(entry => entry.canvas === canvas).map(entry => (
                                <SegmentTile key={entry.segment.name} shown={entry} frame={frame} props={props} />
                            ))}
                        </div>
                    </section>
                );
            })}
            {!canvases.length && (
                <section class="wall-canvas">
                    <div class="wall-frame" style={{ aspectRatio: wall ? wall.program.size.join(' / ') : '16 / 9' }}>
                        <Picture hub={session.pictures} of="wall" isPreviewOnly label="Picture of the wall" />
                    </div>
                </section>
            )}
            {canvases.length > 0 && (
                <Table caption="Outputs" rows={shown} keyOf={entry => `${entry.canvas.name} ${entry.segment.name}`}
                    empty="No outputs."
                    columns={[
                        { name: 'Segment', key: entry => entry.segment.name, show: entry => entry.segment.name },
                        { name: 'Node', key: entry => entry.segment.node, show: entry => entry.segment.node < 0 ? kNone : (
                            <button class="link" onClick={() => props.openNode(entry.segment.node)}>node {entry.segment.node}</button>
                        ) },
                        { name: 'State', key: entry => entry.condition.word, show: entry => <StateMark {...entry.condition} /> },
                        { name: 'Frame', isNumber: true, key: entry => entry.frame, show: entry => count(entry.frame) },
                        { name: 'Skew', isNumber: true, key: entry => entry.behind,
                            hint: 'frames behind the newest output, and time after the first window of this frame',
                            show: skewText },
                        { name: 'Confirmed', isNumber: true, key: entry => entry.ageSeconds,
                            hint: 'time since the picture of this output was confirmed',
                            show: entry => (entry.output ? `${duration(entry.ageSeconds)} ago` : kNone) },
                        { name: 'Picture', show: entry => <code title="hash of the picture">{entry.output?.hash.slice(0, 8) ?? kNone}</code> },
                        { name: 'Draws', isNumber: true, hint: 'replay per frame',
                            key: entry => session.history.latest?.nodes.get(entry.segment.node)?.replayMs ?? 0,
                            show: entry => ms(session.history.latest?.nodes.get(entry.segment.node)?.replayMs) },
                    ]} />
            )}
            {!status && <p class="empty">Waiting for the state of the session.</p>}
        </>
    );
}
