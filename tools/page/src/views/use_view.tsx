// The picture of the program or of its private display, which receives the mouse, keys, touches and text of the viewer
// in control.

import { useEffect, useRef, useState } from 'preact/hooks';
import { ms } from '../parts/format.ts';
import { Picture } from '../parts/picture.tsx';
import { ProgramCursor } from '../parts/program_cursor.tsx';
import { useCell } from '../session/cell.ts';
import { ProgramInput } from '../session/program_input.ts';
import type { Session } from '../session/session.ts';
import type { ViewProps } from './view.ts';

function holderText(session: Session): string {
    const { holder, self } = session;
    if (!holder) return 'Nobody has control.';
    if (holder.client === self?.client) return 'You have control.';
    return `${holder.name || `Viewer ${holder.client}`} has control.`;
}

function PasteForm({ onText }: { onText(text: string): void }) {
    const [text, setText] = useState('');
    return (
        <form class="paste" onSubmit={event => {
            event.preventDefault();
            onText(text);
            setText('');
        }}>
            <input aria-label="Text for the program" placeholder="Text for the program" value={text} autocomplete="off"
                onInput={event => setText(event.currentTarget.value)} />
            <button disabled={!text}>Type</button>
        </form>
    );
}

export function UseView({ session }: ViewProps) {
    const wall = useCell(session.wall);
    useCell(session.viewers);
    useCell(session.status);
    const latency = useCell(session.input.medianMs);
    const [isOneToOne, setOneToOne] = useState(false);
    const [of, setOf] = useState<'wall' | 'desktop'>('wall');
    const [problem, setProblem] = useState('');
    const [size, setSize] = useState<[number, number] | null>(null);
    const surface = useRef<HTMLDivElement>(null);
    const leave = useRef<HTMLButtonElement>(null);
    const input = useRef<ProgramInput | null>(null);
    const hasControl = session.holder !== undefined && session.holder.client === session.self?.client;
    const stream = session.pictures.stream(of);
    const programSize = of === 'wall' && wall && wall.program.size[0] > 0 ? wall.program.size : null;
    const [width, height] = programSize ?? size ?? [16, 9];

    useEffect(() => {
        if (!hasControl) return;
        input.current = new ProgramInput(session, surface.current!, () => leave.current?.focus(), of);
        const end = input.current.listen();
        surface.current!.focus({ preventScroll: true });
        return () => {
            end();
            input.current = null;
        };
    }, [session, hasControl, of]);
    useEffect(() => {
        const tell = () => setProblem(stream.problem);
        tell();
        return stream.listen(tell);
    }, [stream]);

    const oneToOneSize = isOneToOne && size
        ? { width: `${size[0] / devicePixelRatio}px`, height: `${size[1] / devicePixelRatio}px` }
        : { aspectRatio: `${width} / ${height}`, '--ratio': String(width / height) };
    return (
        <section class="use">
            <div class="line toolbar">
                <span class={`holder ${hasControl ? 'mine' : ''}`} role="status">{holderText(session)}</span>
                {session.may('input') && (hasControl
                    ? <button ref={leave} onClick={() => session.perform('input-release')}>Release control</button>
                    : <button class="primary" onClick={() => session.perform('input-take')}>Take control</button>)}
                <button aria-pressed={isOneToOne} onClick={() => setOneToOne(!isOneToOne)}>{isOneToOne ? 'Fit' : '1:1'}</button>
                <button aria-pressed={of === 'desktop'} title="The whole private display of the program, with dialogs and menus"
                    onClick={() => setOf(of === 'wall' ? 'desktop' : 'wall')}>Desktop</button>
                {hasControl && <PasteForm onText={text => input.current?.paste(text)} />}
                <span class="faint">
                    {stream.coding !== 'none' && `${stream.coding}, ${stream.canvas.width} × ${stream.canvas.height}`}
                    {Number.isFinite(latency) && `, input to picture ${ms(latency)}`}
                </span>
            </div>
            <div class={`use-area ${isOneToOne ? 'one-to-one' : ''}`} tabIndex={isOneToOne && !hasControl ? 0 : undefined}
                role={isOneToOne ? 'region' : undefined} aria-label={isOneToOne ? 'Picture in its own size' : undefined}>
                <div ref={surface} class={`surface ${hasControl ? 'active' : ''}`} style={oneToOneSize}
                    tabIndex={hasControl ? 0 : undefined} role={hasControl ? 'application' : undefined}
                    aria-label={hasControl ? 'Program. Shift F6 leaves it.' : undefined}>
                    <Picture hub={session.pictures} of={of} label={of === 'wall' ? 'Picture of the program' : 'Display of the program'}
                        isOneToOne={isOneToOne} onSize={(w, h) => setSize([w, h])} />
                    <ProgramCursor stream={stream} surface={surface} isOwn={hasControl} />
                </div>
            </div>
            {problem && <p role="alert">No picture: {problem}.</p>}
            <p class="faint">
                {hasControl ? 'Keys go to the program while its picture has the focus. Shift+F6 leaves it.'
                    : session.may('input') ? 'Take control to use the program with mouse, keys and touch.'
                        : 'This link shows the program, and does not control it.'}
            </p>
        </section>
    );
}
