// The network: rates over time, and per node its stream, pictures, repairs, losses and clock.

import { useMemo } from 'preact/hooks';
import { Chart } from '../parts/chart.tsx';
import { bytes, byteRate, count, duration, kNone, ms, percent } from '../parts/format.ts';
import { StateMark } from '../parts/state_mark.tsx';
import { Table } from '../parts/table.tsx';
import { useCell } from '../session/cell.ts';
import { conditionOf } from '../session/condition.ts';
import type { NodeStatus } from '../wire/types.ts';
import type { ViewProps } from './view.ts';

// Heads report losses for multicast streams only.
function numberOf(node: NodeStatus, name: string): number | null {
    const value = node[name];
    return typeof value === 'number' ? value : null;
}

export function NetworkView({ session, openNode }: ViewProps) {
    const status = useCell(session.status);
    const roundTrip = useCell(session.roundTripMs);
    const { rates } = session.history;
    const latest = session.history.latest;
    const x = useMemo(() => rates.map(entry => entry.atSeconds), [status]);
    const series = useMemo(() => [
        { label: 'programs → head', values: rates.map(entry => [...entry.programs.values()].reduce((sum, rate) => sum + rate.bytes, 0)) },
        ...(status?.nodes ?? []).map(node => ({
            label: `node ${node.node} → head`,
            values: rates.map(entry => entry.nodes.get(node.node)?.pictureBytes ?? null),
        })),
    ], [status]);
    const end = x[x.length - 1] ?? 0;
    const delta = status?.delta;
    const multicast = status?.multicast;
    const shown = (status?.nodes ?? []).some(node => numberOf(node, 'lost') !== null);
    return (
        <>
            <section>
                <h2>Bytes per second</h2>
                {x.length > 1 ? <Chart title="Bytes per second" x={x} series={series} height={190} format={byteRate}
                    formatX={at => `${Math.round(at - end)} s`} /> : <p class="empty">Rates need two states of the session.</p>}
            </section>
            <Table caption="Network of each node" rows={status?.nodes ?? []} keyOf={node => node.node} empty="Waiting for the state of the session."
                columns={[
                    { name: 'Node', key: node => node.node, show: node => <button class="link" onClick={() => openNode(node.node)}>node {node.node}</button> },
                    { name: 'State', key: node => node.state, show: node => <StateMark {...conditionOf(node, latest)} /> },
                    { name: 'Stream', key: node => node.stream, show: node => node.stream },
                    { name: 'Pictures', isNumber: true, key: node => latest?.nodes.get(node.node)?.pictureBytes ?? 0,
                        show: node => byteRate(latest?.nodes.get(node.node)?.pictureBytes) },
                    { name: 'Of raw', isNumber: true, hint: 'transferred share of the raw pictures', key: node => node.pictureBytes / (node.pictureRawBytes || 1),
                        show: node => (node.pictureRawBytes ? percent(node.pictureBytes / node.pictureRawBytes) : kNone) },
                    ...(shown ? [
                        { name: 'Dropped', isNumber: true, hint: 'datagrams that its socket dropped', key: (node: NodeStatus) => numberOf(node, 'dropped') ?? 0,
                            show: (node: NodeStatus) => count(numberOf(node, 'dropped')) },
                        { name: 'Lost', isNumber: true, hint: 'datagrams that the network lost', key: (node: NodeStatus) => numberOf(node, 'lost') ?? 0, show: (node: NodeStatus) => count(numberOf(node, 'lost')) },
                    ] : []),
                    { name: 'Losses', isNumber: true, hint: 'returns of the node after a loss', key: node => node.joins, show: node => count(node.joins) },
                    { name: 'Snapshots', isNumber: true, key: node => node.snapshotBytes, show: node => bytes(node.snapshotBytes) },
                    { name: 'Silent', isNumber: true, key: node => node.silentSeconds, show: node => duration(node.silentSeconds) },
                    { name: 'Clock', isNumber: true, hint: 'bound of the error; known while the timeline is open',
                        show: node => {
                            const clock = session.frames.clocks.find(entry => entry.node === node.node);
                            return clock ? `± ${ms(clock.errorNs / 1e6)}` : kNone;
                        } },
                ]} />
            <dl class="facts wide">
                <div><dt>This page</dt><dd>round trip {ms(roundTrip)}</dd></div>
                {delta && <div><dt>Delta coding</dt><dd>{bytes(delta.rawBytes)} became {bytes(delta.wireBytes)} ({percent((delta.wireBytes ?? 0) / (delta.rawBytes || 1))})</dd></div>}
                {multicast && <div><dt>Multicast</dt><dd>{count(multicast.repairs)} of {count(multicast.datagrams)} datagrams sent again, {count(multicast.parity)} for correction</dd></div>}
                {!delta && <div><dt>Delta coding</dt><dd>off</dd></div>}
            </dl>
        </>
    );
}
