// One node: its state, times, losses and log, and the operations on it.

import { useEffect, useRef, useState } from 'preact/hooks';
import { ConfirmButton } from '../parts/confirm_button.tsx';
import { bytes, byteRate, count, duration, kNone, ms, short } from '../parts/format.ts';
import { LogLines, parseLog } from '../parts/log_lines.tsx';
import { Picture } from '../parts/picture.tsx';
import { Spark } from '../parts/spark.tsx';
import { StateMark } from '../parts/state_mark.tsx';
import { useCell } from '../session/cell.ts';
import { conditionOf, reasonOf } from '../session/condition.ts';
import type { Session } from '../session/session.ts';
import { partOf, segmentsOfNode } from '../session/wall_geometry.ts';
import { OperationError } from '../wire/connection.ts';
import type { LogLine, NodeStatus, PlanChange } from '../wire/types.ts';

const kLogLines = 60;
const kLogMs = 4000;
const kIdentifyMs = 8000;

function perFrame(value: number | undefined): string {
    return Number.isFinite(value) ? `${ms(value)} per frame` : kNone;
}

function Facts({ node, session }: { node: NodeStatus; session: Session }) {
    const rates = session.history.latest?.nodes.get(node.node);
    const clock = session.frames.clocks.find(entry => entry.node === node.node);
    const facts: [string, string][] = [
        ['Host', `${node.where}, pid ${node.pid}`],
        ['GPU', node.gl || kNone],
        ['Frames', `${count(node.frames)}, ${short(rates?.framesPerSecond)} per s`],
        ['Replay', perFrame(rates?.replayMs)],
        ['Readback', perFrame(rates?.readbackMs)],
        ['Pictures', `${byteRate(rates?.pictureBytes)} of ${byteRate(rates?.pictureRawBytes)} raw`],
        ['Stream', node.stream],
        ['Last message', `${duration(node.silentSeconds)} ago`],
        ['Losses', node.joins ? `${node.joins}, back after ${duration(node.secondsToRejoin)}, snapshot ${bytes(node.snapshotBytes)}` : 'none'],
    ];
    if (clock) facts.push(['Clock', `offset ${ms(clock.offsetNs / 1e6)}, error below ${ms(clock.errorNs / 1e6)}`]);
    return <dl class="facts">{facts.map(([name, value]) => <div key={name}><dt>{name}</dt><dd>{value}</dd></div>)}</dl>;
}

function Replace({ node, session }: { node: NodeStatus; session: Session }) {
    const [host, setHost] = useState('');
    const [plan, setPlan] = useState<PlanChange | null>(null);
    const args = { from: node.where, to: host.trim() };
    const move = async (isDry: boolean) => {
        const result = await session.perform<PlanChange>('move-nodes', isDry ? { ...args, 'dry-run': true } : args,
            isDry ? '' : `The nodes of ${node.where} run on ${args.to}.`);
        setPlan(isDry ? result : null);
    };
    return (
        <form class="replace" onSubmit={event => {
            event.preventDefault();
            void move(plan === null);
        }}>
            <label>
                Replace host {node.where} with
                <input value={host} required placeholder="host" autocomplete="off" spellcheck={false}
                    onInput={event => { setHost(event.currentTarget.value); setPlan(null); }} />
            </label>
            <button>{plan ? 'Replace now' : 'Check'}</button>
            {plan && <p class="faint" role="status">
                {plan.left?.length ?? 0} nodes end, {plan.joined?.length ?? 0} start.{' '}
                {plan.warnings?.map(warning => `${warning} `)}
            </p>}
        </form>
    );
}

function Actions({ node, session }: { node: NodeStatus; session: Session }) {
    const [mustForce, setMustForce] = useState(false);
    const [isNamed, setNamed] = useState(false);
    const number = { node: node.node };
    useEffect(() => setMustForce(false), [node.state]);
    const stop = async () => {
        try {
            await session.request('stop-node', mustForce ? { ...number, force: true } : number);
            session.notify('info', `Node ${node.node} stops.`);
            setMustForce(false);
        } catch (error) {
            const text = error instanceof OperationError ? error.message : String(error);
            session.notify('error', text);
            setMustForce(/force/.test(text));
        }
    };
    const identify = async () => {
        const isDone = await session.perform('overlay', { mode: 'names', ...number }, `Node ${node.node} shows its name on the wall.`);
        if (!isDone) return;
        setNamed(true);
        setTimeout(() => {
            setNamed(false);
            void session.perform('overlay', { mode: 'off', ...number });
        }, kIdentifyMs);
    };
    const isEnded = node.state === 'stopped' || node.state === 'lost';
    return (
        <div class="buttons">
            <ConfirmButton question="Restart it now" disabled={node.state === 'stopped'}
                onConfirm={() => session.perform('restart-node', number, `Node ${node.node} restarts.`)}>Restart</ConfirmButton>
            <ConfirmButton question={mustForce ? 'Its part stays as it is' : 'Stop it now'} disabled={isEnded} onConfirm={stop}>
                {mustForce ? 'Stop anyway' : 'Stop'}
            </ConfirmButton>
            <button disabled={!isEnded} onClick={() => session.perform('start-node', number, `Node ${node.node} starts.`)}>Start</button>
            <button disabled={isNamed || isEnded} onClick={identify}>{isNamed ? 'Name is shown' : 'Identify'}</button>
        </div>
    );
}

function useNodeLog(session: Session, node: number): LogLine[] | string {
    const [lines, setLines] = useState<LogLine[] | string>('loading');
    useEffect(() => {
        let isOver = false;
        const load = () => session.fetch(`api/v1/nodes/${node}/log?lines=${kLogLines}`)
            .then(response => response.text())
            .then(text => { if (!isOver) setLines(parseLog(text)); })
            .catch(error => { if (!isOver) setLines(String(error.message ?? error)); });
        void load();
        const timer = setInterval(load, kLogMs);
        return () => { isOver = true; clearInterval(timer); };
    }, [session, node]);
    return lines;
}

function NodeLog({ session, node }: { session: Session; node: number }) {
    const lines = useNodeLog(session, node);
    return typeof lines === 'string' ? <p class="empty">{lines === 'loading' ? 'Loading the log.' : lines}</p>
        : <LogLines lines={lines} label={`Log of node ${node}`} />;
}

export function NodeDrawer({ session, node: number, onClose }: { session: Session; node: number; onClose(): void }) {
    const status = useCell(session.status);
    const wall = useCell(session.wall);
    const close = useRef<HTMLButtonElement>(null);
    useEffect(() => close.current?.focus(), [number]);
    const node = status?.nodes.find(entry => entry.node === number);
    const rates = session.history.rates;
    const reason = node ? reasonOf(node, session.history.latest, session.events.value, session.log.value) : '';
    const segments = segmentsOfNode(wall, number);
    const segment = segments[0];
    const canvas = segment && wall!.canvases.find(entry => entry.segments.includes(segment));
    return (
        <div class="drawer" role="dialog" aria-label={`Node ${number}`}
            onKeyDown={event => { if (event.key === 'Escape') onClose(); }}>
            <header>
                <h2>Node {number}</h2>
                {node && <StateMark {...conditionOf(node, session.history.latest)} />}
                <button ref={close} class="icon" aria-label="Close" onClick={onClose}>✕</button>
            </header>
            {reason && <p class="reason">{reason}</p>}
            {segments.length > 0 && <p class="faint">{segments.map(entry => entry.name
                + (entry.turn ? `, turned ${entry.turn}°` : '')).join(' · ')}</p>}
            {canvas && segment && <div class="drawer-picture" style={{ aspectRatio: `${segment.rectPx[2]} / ${segment.rectPx[3]}` }}>
                <Picture hub={session.pictures} of="wall" part={partOf(segment, canvas)} isPreviewOnly label={`Picture of ${segment.name}`} />
            </div>}
            {!node && <p class="empty">The session has no node {number}.</p>}
            {node && <>
                {session.may('operate') && <Actions node={node} session={session} />}
                <div class="sparks">
                    <figure><figcaption>replay per frame <b>{ms(rates[rates.length - 1]?.nodes.get(number)?.replayMs)}</b></figcaption>
                        <Spark values={rates.map(entry => entry.nodes.get(number)?.replayMs ?? NaN)} label={`Replay time of node ${number}`} /></figure>
                    <figure><figcaption>frames per s <b>{short(rates[rates.length - 1]?.nodes.get(number)?.framesPerSecond)}</b></figcaption>
                        <Spark values={rates.map(entry => entry.nodes.get(number)?.framesPerSecond ?? NaN)} label={`Frames per second of node ${number}`} /></figure>
                </div>
                <Facts node={node} session={session} />
                {session.may('operate') && <>
                    <h3>Log</h3>
                    <NodeLog session={session} node={number} />
                    <Replace node={node} session={session} />
                </>}
            </>}
        </div>
    );
}
