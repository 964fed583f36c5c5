// Log lines of the head and the events of the session.

import { useState } from 'preact/hooks';
import { duration } from '../parts/format.ts';
import { LogLines } from '../parts/log_lines.tsx';
import { useCell, useClock } from '../session/cell.ts';
import type { ViewProps } from './view.ts';

export function LogView({ session }: ViewProps) {
    const lines = useCell(session.log);
    const events = useCell(session.events);
    const [filter, setFilter] = useState('');
    useClock(1000);
    if (!session.may('operate')) return <p class="empty">This link does not show the log.</p>;
    const wanted = filter.toLowerCase();
    const shown = wanted ? lines.filter(line => `${line.topic} ${line.level} ${line.text}`.toLowerCase().includes(wanted)) : lines;
    return (
        <div class="columns">
            <section>
                <div class="line"><h2>Log of the head</h2>
                    <input type="search" aria-label="Filter of lines" placeholder="Filter" value={filter}
                        onInput={event => setFilter(event.currentTarget.value)} /></div>
                <LogLines lines={shown} label="Log of the head" />
            </section>
            <section>
                <h2>Events</h2>
                {!events.length ? <p class="empty">No events since this page opened.</p> : (
                    <ol class="events">
                        {[...events].reverse().map((event, i) => (
                            <li key={events.length - i}>
                                <b>{event.event.replaceAll('-', ' ')}</b>{' '}
                                {typeof event.node === 'number' ? `node ${event.node} ` : ''}{typeof event.text === 'string' ? event.text : ''}
                                <span class="faint"> {duration((performance.now() - event.receivedMs) / 1000)} ago</span>
                            </li>
                        ))}
                    </ol>
                )}
            </section>
        </div>
    );
}
