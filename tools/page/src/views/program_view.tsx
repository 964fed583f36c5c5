// The programs: calls, bytes, waits, round trips and their causes, and the end of the session.

import { ConfirmButton } from '../parts/confirm_button.tsx';
import { bytes, byteRate, count, percent, short } from '../parts/format.ts';
import { useCell } from '../session/cell.ts';
import type { ProgramStatus } from '../wire/types.ts';
import type { ViewProps } from './view.ts';

const kWaits: Record<string, string> = {
    frames: 'nodes draw earlier frames', reply: 'round trips', space: 'full buffers', window: 'its window shows the picture',
};

function RoundTrips({ program }: { program: ProgramStatus }) {
    const causes = Object.entries(program.roundTripsBy).sort((a, b) => b[1] - a[1]);
    if (!causes.length) return <p class="faint">No round trips.</p>;
    const most = causes[0]![1];
    return (
        <ol class="bars" aria-label="Causes of round trips">
            {causes.map(([name, number]) => (
                <li key={name}><code>{name}</code><span class="bar" aria-hidden="true"><span style={{ width: `${(number / most) * 100}%` }} /></span>
                    <span class="number">{count(number)}</span></li>
            ))}
        </ol>
    );
}

export function ProgramView({ session }: ViewProps) {
    const status = useCell(session.status);
    const rates = session.history.latest;
    if (!status) return <p class="empty">Waiting for the state of the session.</p>;
    return (
        <>
            {!status.programs.length && <p class="empty">No program is connected.</p>}
            {status.programs.map(program => {
                const rate = rates?.programs.get(program.client);
                const waits = Object.entries(rate?.waitShare ?? {}).filter(([, share]) => share > 0.005).sort((a, b) => b[1] - a[1]);
                return (
                    <section key={program.client} class="card">
                        <h2 class="command">{program.command}</h2>
                        <dl class="facts wide">
                            <div><dt>Process</dt><dd>{program.pid}</dd></div>
                            <div><dt>Frames</dt><dd>{count(program.frames)}, {short(rate?.framesPerSecond)} per s</dd></div>
                            <div><dt>Calls</dt><dd>{count(program.calls)}, {count((rate?.calls ?? NaN) / (rate?.framesPerSecond || NaN))} per frame</dd></div>
                            <div><dt>Stream</dt><dd>{bytes(program.bytes)}, {byteRate(rate?.bytes)}, {bytes((rate?.bytes ?? NaN) / (rate?.framesPerSecond || NaN))} per frame</dd></div>
                            <div><dt>Round trips</dt><dd>{count(program.roundTrips)}, {short(rate?.roundTrips)} per s</dd></div>
                            <div><dt>Now</dt><dd>{program.waitingFor ? `waits: ${kWaits[program.waitingFor] ?? program.waitingFor}`
                                + (program.waitsForNodes.length ? ` (node ${program.waitsForNodes.join(', ')})` : '') : 'runs'}</dd></div>
                        </dl>
                        <h3>Waits</h3>
                        {!waits.length ? <p class="faint">The program did not wait in the last second.</p> : (
                            <ol class="bars" aria-label="Waits as share of the time">
                                {waits.map(([cause, share]) => (
                                    <li key={cause}><span>{kWaits[cause] ?? cause}</span>
                                        <span class="bar" aria-hidden="true"><span style={{ width: percent(share).replace(' ', '') }} /></span>
                                        <span class="number">{percent(share)}</span></li>
                                ))}
                            </ol>
                        )}
                        <h3>Round trips by command</h3>
                        <RoundTrips program={program} />
                    </section>
                );
            })}
            {session.may('operate') && (
                <section class="card">
                    <h2>Session</h2>
                    <Latency session={session} latency={status.latency} />
                    <div class="buttons">
                        <ConfirmButton question="End the program and the wall" onConfirm={() => session.perform('stop', {}, 'The session ends.')}>
                            End the session
                        </ConfirmButton>
                    </div>
                </section>
            )}
        </>
    );
}

function Latency({ session, latency }: { session: ViewProps['session']; latency: number }) {
    return (
        <label class="row">
            Frames that the program may be ahead
            <input type="number" min="0" max="64" value={latency} onChange={event => {
                const frames = Number(event.currentTarget.value);
                if (Number.isInteger(frames) && frames >= 0 && frames <= 64) void session.perform('latency', { frames });
            }} />
        </label>
    );
}
