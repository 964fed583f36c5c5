// All nodes in a table, the slowest recognizable by a bar.

import { useMemo } from 'preact/hooks';
import { Chart } from '../parts/chart.tsx';
import { count, duration, ms, percent, short } from '../parts/format.ts';
import { StateMark } from '../parts/state_mark.tsx';
import { Table } from '../parts/table.tsx';
import { useCell } from '../session/cell.ts';
import { conditionOf } from '../session/condition.ts';
import type { ViewProps } from './view.ts';

function Bar({ share }: { share: number }) {
    return (
        <span class="bar" aria-hidden="true">
            <span style={{ width: `${Math.round(Math.min(1, Math.max(0, share || 0)) * 100)}%` }} />
        </span>
    );
}

export function NodesView({ session, openNode }: ViewProps) {
    const status = useCell(session.status);
    const rates = session.history.latest;
    const replay = (node: number) => rates?.nodes.get(node)?.replayMs ?? NaN;
    const longest = Math.max(...(status?.nodes ?? []).map(node => replay(node.node)).filter(Number.isFinite));
    const x = useMemo(() => session.history.rates.map(entry => entry.atSeconds), [status]);
    const series = useMemo(() => (status?.nodes ?? []).map(node => ({
        label: `node ${node.node}`, values: session.history.rates.map(entry => finite(entry.nodes.get(node.node)?.replayMs)),
    })), [status]);
    const end = x[x.length - 1] ?? 0;
    return (
        <>
        <Table caption="Nodes" rows={status?.nodes ?? []} keyOf={node => node.node} empty="Waiting for the state of the session."
            columns={[
                { name: 'Node', key: node => node.node, show: node => (
                    <button class="link" onClick={() => openNode(node.node)}>node {node.node}</button>
                ) },
                { name: 'State', key: node => node.state, show: node => <StateMark {...conditionOf(node, rates)} /> },
                { name: 'Host', key: node => node.where, show: node => node.where },
                { name: 'Replay', isNumber: true, hint: 'time of the drawing thread per frame', key: node => replay(node.node), show: node => (
                    <span class="with-bar"><Bar share={replay(node.node) / longest} />{ms(replay(node.node))}</span>
                ) },
                { name: 'Readback', isNumber: true, key: node => rates?.nodes.get(node.node)?.readbackMs ?? 0,
                    show: node => ms(rates?.nodes.get(node.node)?.readbackMs) },
                { name: 'Frames/s', isNumber: true, key: node => rates?.nodes.get(node.node)?.framesPerSecond ?? 0,
                    show: node => short(rates?.nodes.get(node.node)?.framesPerSecond) },
                { name: 'Busy', isNumber: true, hint: 'share of the time in which the drawing thread computes',
                    key: node => busy(rates?.nodes.get(node.node)), show: node => percent(busy(rates?.nodes.get(node.node))) },
                { name: 'Frames', isNumber: true, key: node => node.frames, show: node => count(node.frames) },
                { name: 'Losses', isNumber: true, key: node => node.joins, show: node => count(node.joins) },
                { name: 'Silent', isNumber: true, key: node => node.silentSeconds, show: node => duration(node.silentSeconds) },
                { name: 'Pid', isNumber: true, key: node => node.pid, show: node => String(node.pid) },
                { name: 'GPU', key: node => node.gl, show: node => <span class="clip" title={node.gl}>{node.gl}</span> },
            ]} />
        {x.length > 1 && <section>
            <h2>Replay per frame</h2>
            <Chart title="Replay time per frame of each node" x={x} series={series} height={180} format={ms} formatX={at => `${Math.round(at - end)} s`} />
        </section>}
        </>
    );
}

function finite(value: number | undefined): number | null {
    return value !== undefined && Number.isFinite(value) ? value : null;
}

function busy(rates: { replayMs: number; readbackMs: number; framesPerSecond: number } | undefined): number {
    if (!rates) return NaN;
    return Math.min(1, ((rates.replayMs + rates.readbackMs) * rates.framesPerSecond) / 1000);
}
